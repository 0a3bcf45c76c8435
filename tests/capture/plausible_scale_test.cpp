// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/plausibility.hpp"

#include <gtest/gtest.h>

namespace tacto::capture {
namespace {

schema::CalibrationEntry entry(double scale, double uncertainty, double degrees_of_freedom) {
  schema::CalibrationEntry made;
  made.channel = "normal_force";
  made.nominal_scale = 0.01;
  made.scale = scale;
  made.scale_uncertainty = uncertainty;
  made.degrees_of_freedom = degrees_of_freedom;
  return made;
}

TEST(BelievableScale, IsWithinAFactorOfTwoOfTheDevicesOwn) {
  for (const double scale : {0.0051, 0.01, 0.0199}) EXPECT_EQ(scale_fault(entry(scale, 1e-5, 5)), "");
  for (const double scale : {-0.01, 0.0, 0.0049, 0.0201, 9.9})
    EXPECT_NE(scale_fault(entry(scale, 0, 5)).find("times the nominal scale"), std::string::npos) << scale;
}

TEST(BelievableScale, IsKnownWithinAFifth) {
  EXPECT_EQ(scale_fault(entry(0.01, 0.001, 0)), "");  // 0: not from scatter, which is normal
  EXPECT_EQ(scale_fault(entry(0.01, 0.001, 1)), "the scale of normal_force is known only to +-127 % (95 %)");
}

TEST(BelievableScale, ATareHasNone) {
  schema::CalibrationEntry tare = entry(1, 1, 1);
  tare.scale.reset();
  EXPECT_EQ(scale_fault(tare), "");
}

}  // namespace
}  // namespace tacto::capture

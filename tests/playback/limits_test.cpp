// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tacto::playback {
namespace {

schema::Transducer limited(double drive_v, double displacement_m, double slew_v_per_s) {
  schema::Transducer transducer;
  transducer.drive_limit_v = drive_v;
  transducer.displacement_limit_m = displacement_m;
  transducer.slew_limit_v_per_s = slew_v_per_s;
  return transducer;
}

TEST(Limits, PeaksAreMagnitudesWithTheirTimes) {
  const std::vector<double> drive_v{1, -4, 0}, displacement_m{0, 1e-6, -3e-6};
  const auto peaks = peaks_of(drive_v, displacement_m, 10, limited(5, 4e-6, 100));
  EXPECT_EQ(peaks.drive_v.value, 4);
  EXPECT_EQ(peaks.drive_v.time_s, 0.1);
  EXPECT_EQ(peaks.slew_v_per_s.value, 50);
  EXPECT_EQ(peaks.displacement_m.value, 3e-6);
  EXPECT_EQ(peaks.tightest().name, "drive");
  EXPECT_DOUBLE_EQ(peaks.tightest().used(), 0.8);
  EXPECT_TRUE(peaks.fit());
}

// The device is at zero before and after: the step to the first sample and the step from the last one count.
TEST(Limits, SlewCountsFromAndToRest) {
  const auto first = peaks_of(std::vector<double>{3, 2, 1}, {}, 10, limited(5, 1, 1));
  EXPECT_EQ(first.slew_v_per_s.value, 30);
  EXPECT_EQ(first.slew_v_per_s.time_s, 0);
  const auto last = peaks_of(std::vector<double>{1, 2, 3}, {}, 10, limited(5, 1, 1));
  EXPECT_EQ(last.slew_v_per_s.value, 30);
  EXPECT_DOUBLE_EQ(last.slew_v_per_s.time_s, 0.3);
}

TEST(Limits, RefusalNamesPeakLimitTimeAndGain) {
  const auto peaks = peaks_of(std::vector<double>{0, 7.5, 0}, {}, 10, limited(5, 1, 1e6));
  const auto said = check_limits(peaks, 1e-3, 5e-4);
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().kind, schema::ErrorKind::unsuitable);
  for (const char* value : {"7.5 V", " 5 V"}) EXPECT_NE(said.error().what.find(value), std::string::npos);
  EXPECT_EQ(said.error().where, "drive, 0.1000 s after its start");
  EXPECT_NE(said.error().remedy.find("0.6666mm/N (1.333x)"), std::string::npos) << said.error().remedy;
}

TEST(Limits, ClippingHoldsLevelAndSlew) {
  const auto transducer = limited(1, 1, 100);
  std::vector<double> drive_v{0, 0.5, 3, 3, -3, -3, 0};
  EXPECT_EQ(clip_drive(drive_v, 100, transducer), 4);
  EXPECT_EQ(drive_v, (std::vector<double>{0, 0.5, 1, 1, 0, -1, 0}));
}

}  // namespace
}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/reference_scale.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/capture/sim_take.hpp"
#include "tests/faults.hpp"
#include "tests/sanitized.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;

schema::Result<ReferenceScale> against_net(const Take& take, double relative_uncertainty = 0) {
  const double scale = take.header.channels[3].scale;
  return scale_by_reference(take, "tangential_force", "net_force", {scale, relative_uncertainty * scale});
}

// A piezo whose gain is 8 % too small, under a finger that slides back and forth.
TEST(ReferenceScale, FindsThePiezosGainWithinItsUncertainty) {
  Coverage coverage;
  double worst_percent = 0;
  for (int seed = 1; seed <= draws(20, 4); ++seed) {
    const Take take = sim_take(fmt::format("surface=C,strokes=20,sensor_gain=0.92,seed={}", seed), 8);
    const auto found = against_net(take);
    ASSERT_TRUE(found) << schema::message(found.error());
    coverage.add(found->scale, take.header.channels[0].scale / 0.92);
    worst_percent = std::max(worst_percent, 100 * std::abs(found->ratio * 0.92 - 1));
    EXPECT_LT(std::abs(found->scale.uncertainty / found->scale.value), 0.01);
  }
  EXPECT_TRUE(sanitized() || coverage.inside() >= 0.8);  // of 20: three sigma below 95 %
  EXPECT_TRUE(sanitized() || (coverage.rms() > 0.5 && coverage.rms() < 1.6));
  EXPECT_LT(worst_percent, 1.5);
  coverage.print("reference_scale.scale");
  measured("reference_scale.worst_percent", worst_percent);
}

TEST(ReferenceScale, TheReferencesOwnUncertaintyIsInIt) {
  const Take take = sim_take("surface=C,strokes=20", 8);
  const auto alone = against_net(take), with = against_net(take, 0.03);
  ASSERT_TRUE(alone && with);
  EXPECT_EQ(alone->scale.value, with->scale.value);
  EXPECT_NEAR(std::abs(with->scale.uncertainty / with->scale.value),
              std::hypot(alone->scale.uncertainty / alone->scale.value, 0.03), 1e-9);
}

TEST(ReferenceScale, WrongInputsAreNamed) {
  const Take take = sim_take("surface=C,strokes=20", 5.5);
  EXPECT_EQ(scale_by_reference(take, "tangential_force", "no_force", {1, 0}).error().kind, ErrorKind::usage);
  EXPECT_EQ(scale_by_reference(take, "tangential_force", "position", {1, 0}).error().kind, ErrorKind::usage);
  EXPECT_EQ(scale_by_reference(take, "net_force", "normal_force", {1, 0}).error().kind,
            ErrorKind::unsuitable);
  EXPECT_NE(against_net(sim_take("surface=C,strokes=20", 3)).error().what.find(" 5 s"), std::string::npos);
  const auto quiet = against_net(sim_take("finger=up", 6));
  EXPECT_TRUE(tests::fails(quiet, ErrorKind::unsuitable, "tangential_force"));
  const double scale = take.header.channels[3].scale;
  const auto turned = scale_by_reference(take, "tangential_force", "net_force", {-scale, 0});
  ASSERT_FALSE(turned);
  EXPECT_NE(turned.error().what.find("opposite sign"), std::string::npos);
}

}  // namespace
}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/weights.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/capture/sim_take.hpp"
#include "tests/faults.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;

Weighing weighed(const std::string& channel, const std::string& keys, double force_n) {
  const Take take = sim_take("finger=up," + keys, 0.5);
  const auto weighing = weighing_of(take, channel, force_n);
  EXPECT_TRUE(weighing) << schema::message(weighing.error());
  return *weighing;
}

// A cell that shows 3 % too much needs a scale in newtons that is 3 % smaller.
TEST(Weights, FindALoadCellsScaleAndZeroWithinTheirUncertainty) {
  const Take own = sim_take("finger=up", 0.2);
  const double scale = own.header.channels[2].scale / 1.03;
  Coverage scales, zeros;
  for (int seed = 1; seed <= 40; ++seed) {
    std::vector<Weighing> weighings;
    for (const double force_n : {0.0, 0.5, 1.0, 2.0})
      weighings.push_back(weighed("normal_force",
                                  fmt::format("cell_gain=1.03,cell_zero=-0.2N,weight={}N,seed={}", force_n,
                                              10 * seed + static_cast<int>(2 * force_n)),
                                  force_n));
    const auto found = scale_by_weights(weighings, 0);
    ASSERT_TRUE(found) << schema::message(found.error());
    scales.add(found->scale, scale);
    zeros.add(found->zero, -0.2 / own.header.channels[2].scale);
    EXPECT_NEAR(found->scale.value / scale, 1, 2e-3);
  }
  scales.print("weights.scale");
  zeros.print("weights.zero");
  for (const Coverage& coverage : {scales, zeros}) {
    EXPECT_GE(coverage.inside(), 0.85);  // of 40: three sigma below 95 %
    EXPECT_LT(coverage.rms(), 1.4);
    EXPECT_GT(coverage.rms(), 0.5);
  }
}

TEST(Weights, PullsCalibrateTheNetForce) {
  const double own_scale = sim_take("finger=up", 0.2).header.channels[3].scale;
  const std::vector<Weighing> weighings = {weighed("net_force", "cell_gain=0.9,pull=-1N", -1),
                                           weighed("net_force", "cell_gain=0.9,pull=1N,seed=2", 1)};
  const auto found = scale_by_weights(weighings, 0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->scale.value, own_scale / 0.9, 4 * found->scale.uncertainty);
}

// Closed form: two points and their uncertainties.
TEST(Weights, TwoPointsCarryTheirNoiseThrough) {
  const std::vector<Weighing> weighings = {{0, {100, 3, 19}}, {2, {1100, 4, 19}}};
  const auto found = scale_by_weights(weighings, 0);
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->scale.value, 2e-3);
  EXPECT_NEAR(found->scale.uncertainty, 2e-3 * 5 / 1000, 1e-12);
  EXPECT_NEAR(found->zero.value, 100, 1e-9);
  EXPECT_NEAR(found->zero.uncertainty, 3, 1e-9);
  EXPECT_EQ(found->scale.degrees_of_freedom, 19);
  const auto with_gravity = scale_by_weights(weighings, 0.01);
  EXPECT_NEAR(with_gravity->scale.uncertainty, 2e-3 * std::hypot(0.005, 0.01), 1e-12);
}

// Errors of the weights beyond the noise appear in the residuals and increase the uncertainty.
TEST(Weights, AWrongWeightWidensTheUncertainty) {
  std::vector<Weighing> weighings = {
      {0, {0, 1, 19}}, {1, {1000, 1, 19}}, {2, {2000, 1, 19}}, {3, {3000, 1, 19}}};
  const auto right = scale_by_weights(weighings, 0);
  weighings[2].force_n = 2.1;
  const auto wrong = scale_by_weights(weighings, 0);
  EXPECT_GT(wrong->scale.uncertainty, 20 * right->scale.uncertainty);
  EXPECT_NEAR(wrong->largest_residual_n, 0.07, 0.02);
  EXPECT_EQ(wrong->scale.degrees_of_freedom, 2);
}

TEST(Weights, ThePiezoForgetsThemAndThatIsSaid) {
  const auto refused = weighing_of(sim_take("finger=up,pull=1N", 0.5), "tangential_force", 1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(refused.error().where, "tangential_force");
  EXPECT_NE(refused.error().remedy.find("--reference"), std::string::npos);
}

TEST(Weights, WrongInputsAreNamed) {
  const Take take = sim_take("finger=up,weight=1N", 0.5);
  EXPECT_EQ(weighing_of(take, "no_force", 1).error().kind, ErrorKind::usage);
  EXPECT_EQ(weighing_of(take, "position", 1).error().kind, ErrorKind::unsuitable);
  const auto sliding = weighing_of(sim_take("surface=flat,strokes=4", 1.5), "normal_force", 1);
  EXPECT_TRUE(tests::fails(sliding, ErrorKind::unsuitable, "normal_force"));
  const auto heavy = weighing_of(sim_take("finger=up,weight=15N,cell_gain=1.5", 0.5), "normal_force", 15);
  EXPECT_TRUE(tests::fails(heavy, ErrorKind::unsuitable, "normal_force"));
  const Weighing one = *weighing_of(take, "normal_force", 1);
  EXPECT_EQ(scale_by_weights(std::vector{one, one}, 0).error().kind, ErrorKind::unsuitable);
  Weighing same = one;
  same.force_n = 2;  // other weights, the same numbers
  EXPECT_EQ(scale_by_weights(std::vector{one, same}, 0).error().kind, ErrorKind::unsuitable);
}

}  // namespace
}  // namespace tacto::capture

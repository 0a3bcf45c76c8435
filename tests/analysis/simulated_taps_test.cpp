// SPDX-License-Identifier: GPL-3.0-or-later
// Taps on a wall, simulated: the figures of issue 33, computed again by a program of 30 lines in C.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/design/simulated_taps.hpp"
#include "playback/prepare/scene/scene_device.hpp"

namespace tacto::analysis {
namespace {

schema::Device line_of(double mass_kg, double viscous, double coulomb_n, double step_m) {
  schema::Device device;
  device.name = "line";
  schema::DeviceAxis axis;
  axis.name = "x";
  axis.mass_kg = mass_kg;
  axis.viscous_n_s_per_m = viscous;
  axis.coulomb_n = coulomb_n;
  axis.encoder_step_m = step_m;
  axis.travel_from_m = -0.1;
  axis.travel_to_m = 0.1;
  axis.peak_force_n = axis.continuous_force_n = 100;
  device.axes = {axis};
  device.peak_force_n = device.continuous_force_n = 100;
  device.slew_n_per_s = 1e6;
  device.rates_hz = {1000};
  return device;
}

// From x = 0 on, pushing towards -x.
schema::Scene wall_of(double stiffness_n_per_m, double damping = 0) {
  schema::Patch patch;
  patch.name = "wall";
  patch.x_m = 0.05;
  patch.width_m = patch.height_m = 0.1;
  patch.layers = {schema::SpringLayer{{stiffness_n_per_m}, {-0.05}, {0}, ""}};
  if (damping > 0) patch.layers.push_back(schema::DamperLayer{{damping}, ""});
  schema::Scene scene;
  scene.patches = {patch};
  return scene;
}

struct Wall {
  schema::Device device;
  schema::Scene scene;
  playback::PreparedScene prepared;
  core::ForceSetup setup;
  schema::Hand hand;
  TapBench bench;
  TapPlace at;

  Wall(schema::Device of, double stiffness_n_per_m, double damping = 0)
      : device(std::move(of)),
        scene(wall_of(stiffness_n_per_m, damping)),
        prepared(*playback::prepare_scene(scene, "wall", device, 1000)),
        setup(*playback::force_setup_of(device, 1000)),
        bench(scene, prepared, device, setup, hand),
        at(*bench.stiffest({{0}, 0, 0}, 0)) {}
};

TEST(SimulatedTaps, TheStiffestPlaceOfAWallIsItsEdge) {
  const Wall wall(line_of(0.075, 0.5, 0, 30e-6), 500);
  EXPECT_NEAR(wall.at.place_m[0], 0, 1e-9);
  EXPECT_EQ(wall.at.sign, 1);
  EXPECT_NEAR(wall.at.stiffness_n_per_m, 500, 0.1);
  EXPECT_NEAR(wall.at.extent_m, 0.1, 0.011);  // in steps of a tenth
}

// Issue 33: about 0.2, 0.5, 1.3 and 28 counts RMS at 0.3, 0.6, 0.9 and 1.05 of 2 b / T = 1 kN/m. The program
// in C gives, in the last 4 of 16 s, 0.11 to 0.19, 0.27 to 0.48, 0.7 to 2 (still decaying) and 27.7.
TEST(SimulatedTaps, AWallOscillatesBelowTheProvedLimit) {
  const double expected[][3] = {{300, 0.1, 0.3}, {600, 0.25, 0.6}, {900, 0.6, 2.5}, {1050, 27, 28.5}};
  for (const auto& [stiffness, low, high] : expected) {
    const Wall wall(line_of(0.075, 0.5, 0, 30e-6), stiffness);
    double least = INFINITY, most = 0;
    for (const double push : {0.3, 1.0})
      for (const double speed : {0.02, 0.1, 0.3}) {
        const SimulatedTap tap = wall.bench.tap(wall.at, push, speed);
        if (push == 1 || stiffness < 1000) most = std::max(most, tap.rms_counts);
        least = std::min(least, tap.rms_counts);
      }
    printf("  %.0f N/m: %.2f to %.2f counts RMS\n", stiffness, least, most);
    EXPECT_GT(least, stiffness < 1000 ? low : 7) << stiffness;  // 0.3 N: 8.4 counts
    EXPECT_GT(most, low) << stiffness;
    EXPECT_LT(most, high) << stiffness;
  }
}

// The issue says that it does not oscillate. The force of one count is above 0.02 N from 667 N/m on, so it
// swings about the first count: by 1 count RMS, where 1 N gives 45.
TEST(SimulatedTaps, ALightPushSwingsByACount) {
  const Wall wall(line_of(0.075, 0.5, 0, 30e-6), 1500);
  const double light = wall.bench.tap(wall.at, 0.02, 0.02).rms_counts;
  const double strong = wall.bench.tap(wall.at, 1, 0.02).rms_counts;
  printf("  1500 N/m: %.2f counts RMS at 0.02 N, %.1f at 1 N\n", light, strong);
  EXPECT_LT(light, 1.6);
  EXPECT_NEAR(strong, 45, 1.5);
}

TEST(SimulatedTaps, FrictionStopsATapThatGrowsWithoutIt) {
  const Wall with(line_of(0.075, 0.5, 0.05, 1e-6), 1200), without(line_of(0.075, 0.5, 0, 1e-6), 1200);
  EXPECT_LT(with.bench.tap(with.at, 0.3, 0.02).rms_counts, 0.01);
  EXPECT_EQ(without.bench.tap(without.at, 0.3, 0.02).end, TapEnd::oscillates);
}

TEST(SimulatedTaps, APushBelowFrictionLeavesTheHandBesideTheWall) {
  const Wall wall(line_of(0.075, 0.5, 0.05, 1e-6), 1100);
  for (const double speed : {0.02, 0.1, 0.3})
    EXPECT_EQ(wall.bench.tap(wall.at, 0.02, speed).end, TapEnd::rests) << speed;
}

// A spring in the middle of its patch, at 0.95 and 1.2 of its limit: 20 % more grow by e in 0.25 s.
TEST(SimulatedTaps, ASpringBeyondItsLimitGrows) {
  for (const double factor : {0.95, 1.2}) {
    const Wall wall(line_of(0.1, 1, 0, 1e-6), 1);
    const double limit = playback::stiffness_limit_of(wall.device, 1000, std::nullopt);
    schema::Scene scene = wall_of(limit * factor);
    scene.patches[0].x_m = 0;
    scene.patches[0].layers = {schema::SpringLayer{{limit * factor}, {0}, {0}, ""}};
    const auto prepared = playback::prepare_scene(scene, "spring", wall.device, 1000);
    ASSERT_TRUE(prepared);
    const TapBench bench(scene, *prepared, wall.device, wall.setup, wall.hand);
    const auto at = bench.stiffest({{0}, 0, 0}, 0);
    ASSERT_TRUE(at);
    EXPECT_EQ(bench.worst(*at).end, factor < 1 ? TapEnd::rests : TapEnd::grows) << factor;
  }
}

// The computed limit has no encoder, and the speed of a slow hand is late in the kernel: without friction
// taps rest within a count up to about a third of it.
TEST(SimulatedTaps, ADamperOfAverageSpeedIsLate) {
  for (const double step_m : {1e-7, 1e-5}) {
    const Wall wall(line_of(0.075, 0.1, 0, step_m), 100, 10);
    const double limit = playback::stiffness_limit_of(wall.device, 1000, std::nullopt, 10);
    const auto factor = wall.bench.resting_factor(wall.at, 1.2 * limit / 100);
    ASSERT_TRUE(factor);
    printf("  step %g m: computed %.0f N/m, simulated %.0f N/m\n", step_m, limit, 100 * *factor);
    EXPECT_GT(100 * *factor, 0.15 * limit);
    EXPECT_LT(100 * *factor, 0.5 * limit);
  }
}

}  // namespace
}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/finger_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tacto::firmware_host {
namespace {

constexpr double kStepS = 1e-4;

std::vector<FingerPlace> places(const StrokePlan& plan, double time_s) {
  FingerPath path(plan, kStepS, Random(5, 0));
  std::vector<FingerPlace> all;
  for (int i = 0; i < static_cast<int>(time_s / kStepS); ++i) all.push_back(path.step());
  return all;
}

TEST(FingerPath, GoesThereAndBackAndStays) {
  const auto path = places({.from_m = 2e-3, .to_m = 38e-3}, 2.5);
  double farthest = 0, nearest = 1;
  for (std::size_t i = 1; i < path.size(); ++i) {
    farthest = std::max(farthest, path[i].position_m);
    nearest = std::min(nearest, path[i].position_m);
    EXPECT_NEAR(path[i].position_m - path[i - 1].position_m, path[i].speed_mps * kStepS, 1.1e-6) << i;
  }
  EXPECT_EQ(farthest, 38e-3);
  EXPECT_EQ(nearest, 2e-3);
  EXPECT_EQ(path.back().position_m, 2e-3);
  EXPECT_EQ(path.back().speed_mps, 0);
  EXPECT_EQ(path[900].position_m, 2e-3);  // rests for 0.1 s
}

TEST(FingerPath, WithoutWanderKeepsItsSpeedBetweenTheRamps) {
  const auto path = places({.from_m = 0, .to_m = 36e-3, .speed_mps = 0.04, .strokes = 1, .wander = 0}, 2);
  for (const FingerPlace& place : path) {
    if (place.position_m > 2.1e-3 && place.position_m < 33.9e-3) {
      EXPECT_EQ(place.speed_mps, 0.04);
    }
  }
  EXPECT_EQ(path.back().position_m, 36e-3);
}

TEST(FingerPath, EasesItsLoadWhereItRests) {
  const auto path = places({.from_m = 0, .to_m = 36e-3}, 1);
  EXPECT_DOUBLE_EQ(path[10].press, 0.1);
  EXPECT_DOUBLE_EQ(path[5000].press, 1);
}

// 60 knots of speed variation over a long stroke: their RMS is known to about 15 %, so 0.2 covers three
// errors.
TEST(FingerPath, WandersByWhatIsAsked) {
  const auto path = places({.from_m = 0, .to_m = 1, .strokes = 1}, 15);
  double squares = 0;
  for (std::size_t i = 3000; i < path.size(); ++i) squares += std::pow(path[i].speed_mps / 0.05 - 1, 2);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(path.size() - 3000)), 0.1, 0.04);
}

TEST(FingerPath, NoStrokesIsNoMotion) {
  const auto path = places({.from_m = 1e-3, .to_m = 36e-3, .strokes = 0}, 0.5);
  EXPECT_EQ(path.back().position_m, 1e-3);
}

}  // namespace
}  // namespace tacto::firmware_host

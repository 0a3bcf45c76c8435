// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/stroke_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tacto::capture {
namespace {

constexpr double kRate_hz = 1000;

// Goes to a position at a speed, then rests.
void go(StrokeCounter& counter, double& at_m, double to_m, double speed_mps, double load_n, int rest = 0) {
  const double step_m = speed_mps / kRate_hz * (to_m > at_m ? 1 : -1);
  for (auto left = static_cast<int>(std::lround(std::abs((to_m - at_m) / step_m))); left > 0; --left)
    counter.add(at_m += step_m, load_n);
  for (int i = 0; i < rest; ++i) counter.add(at_m, 9);
}

TEST(StrokeCounter, ThereAndBackAreTwo) {
  StrokeCounter counter(kRate_hz);
  double at_m = 0;
  go(counter, at_m, 0, 1, 0, 300);
  go(counter, at_m, 0.04, 0.05, 0.5);
  go(counter, at_m, 0, 0.04, 0.3, 200);
  ASSERT_EQ(counter.strokes().size(), 2U);
  const CountedStroke &forth = counter.strokes()[0], &back = counter.strokes()[1];
  EXPECT_NEAR(forth.length_m, 0.04, StrokeCounter::kTurn_m);  // it begins within that of its start
  EXPECT_NEAR(forth.mean_speed_mps, 0.05, 0.05 * 0.02);
  EXPECT_NEAR(forth.mean_normal_n, 0.5, 0.5 * 0.02);
  EXPECT_EQ(forth.direction, 1);
  EXPECT_EQ(back.direction, -1);
  EXPECT_NEAR(back.mean_speed_mps, 0.04, 0.04 * 0.03);
  EXPECT_NEAR(back.mean_normal_n, 0.3, 0.3 * 0.03);
}

TEST(StrokeCounter, AShortHaltDoesNotEndAStroke) {
  StrokeCounter counter(kRate_hz);
  double at_m = 0;
  go(counter, at_m, 0.02, 0.05, 0.5, 100);
  go(counter, at_m, 0.04, 0.05, 0.5, 200);
  EXPECT_EQ(counter.strokes().size(), 1U);
}

TEST(StrokeCounter, TrembleAndShortWaysAreNone) {
  StrokeCounter counter(kRate_hz);
  double at_m = 0;
  for (int i = 0; i < 20; ++i) go(counter, at_m, i % 2 == 0 ? 0.004 : 0, 0.05, 0.5, 50);
  EXPECT_TRUE(counter.strokes().empty());
}

TEST(StrokeCounter, OneCountOfDitherDoesNotTurnAStroke) {
  StrokeCounter counter(kRate_hz);
  for (int i = 0; i < 1000; ++i) counter.add(50e-6 * i - (i % 3 == 0 ? 100e-6 : 0), 0.5);
  EXPECT_TRUE(counter.strokes().empty());  // still going on
  for (int i = 0; i < 200; ++i) counter.add(0.05, 0.5);
  EXPECT_EQ(counter.strokes().size(), 1U);
}

}  // namespace
}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware-host/sim/physics/spline_noise.hpp"

namespace tacto::firmware_host {
namespace {

// Tolerances: five standard errors of the estimate from n samples.
TEST(Random, NormalHasTheMomentsOfItsSum) {
  Random random(7, 0);
  constexpr int kSamples = 400000;
  double sum = 0, squares = 0, fourths = 0, largest = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = random.normal();
    sum += x, squares += x * x, fourths += x * x * x * x;
    largest = std::max(largest, std::abs(x));
  }
  EXPECT_NEAR(sum / kSamples, 0, 5 / std::sqrt(kSamples));
  EXPECT_NEAR(squares / kSamples, 1, 5 * std::sqrt(1.9 / kSamples));
  EXPECT_NEAR(fourths / kSamples, 2.9, 5 * std::sqrt(90.0 / kSamples));
  EXPECT_LT(largest, 6);
}

TEST(Random, StreamsAndSeedsDiffer) {
  const double first = Random(1, 1).uniform();
  EXPECT_EQ(Random(1, 1).uniform(), first);
  EXPECT_NE(Random(1, 2).uniform(), first);
  EXPECT_NE(Random(2, 1).uniform(), first);
}

// The knots are independent: 4000 of them give the RMS to 5 x 1 / sqrt(2 x 4000) = 6 %.
TEST(SplineNoise, HasUnitRmsAndIsSmooth) {
  SplineNoise curve(Random(3, 0), 0.25);
  double squares = 0, before = curve.at(0), steepest = 0;
  constexpr int kSteps = 1000000;
  for (int i = 1; i <= kSteps; ++i) {
    const double value = curve.at(i * 1e-3);
    squares += value * value;
    steepest = std::max(steepest, std::abs(value - before));
    before = value;
  }
  EXPECT_NEAR(std::sqrt(squares / kSteps), 1, 0.06);
  EXPECT_LT(steepest, 6 * 2 * 1.4443 * 1e-3 / 0.25);  // two coefficients of at most 6, one a knot apart
}

}  // namespace
}  // namespace tacto::firmware_host

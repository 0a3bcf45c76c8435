// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/align_textures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace tacto::spatial {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Lines at 40 incommensurate frequencies up to a fiftieth of the grid's highest, so that no other shift
// agrees as well.
double surface(double pitches) {
  double sum = 0;
  for (int k = 1; k <= 40; ++k)
    sum += std::sin(kTurn * pitches * 0.00025 * k * (1 + 0.013 * std::sqrt(k)) + 2.4 * k * k);
  return sum;
}

std::vector<double> seen(double from, std::size_t count, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(surface(from + static_cast<double>(i)) + noise * normal(random));
  return values;
}

TEST(AlignTextures, RecoversAShiftBetweenPitches) {
  const auto a = seen(1000, 20000, 0, 1);
  for (const double shift : {0.0, 0.25, -17.6, 130.5, -299.9}) {
    // The origin of b is stated as 1500, but is 1500 + `shift`.
    const auto b = seen(1500 + shift, 18000, 0, 1);
    const Alignment found = align({1000, a}, {1500, b}, 500);
    ASSERT_TRUE(found.found) << shift;
    EXPECT_NEAR(found.shift, shift, 0.01);
    EXPECT_NEAR(found.correlation, 1, 1e-4);
  }
}

TEST(AlignTextures, NoiseOfTheSurfacesSizeLeavesAPitch) {
  const auto a = seen(0, 40000, 4.5, 2), b = seen(33.3, 40000, 4.5, 3);
  const Alignment found = align({0, a}, {0, b}, 200);
  ASSERT_TRUE(found.found);
  // Tolerance: the Cramer-Rao bound for both, 2 sigma^2 / sum f'^2, times 5.
  double slopes = 0;
  for (int i = 0; i < 40000; ++i) slopes += std::pow(surface(i + 0.5) - surface(i - 0.5), 2);
  EXPECT_NEAR(found.shift, 33.3, 5 * std::sqrt(2 * 4.5 * 4.5 / slopes));
  EXPECT_NEAR(found.correlation, 0.5, 0.05);  // noise and surface are equal in each
}

TEST(AlignTextures, SaysWhereItFindsNothing) {
  const auto a = seen(0, 10000, 0, 1), b = seen(400, 10000, 0, 1);
  EXPECT_FALSE(align({0, a}, {0, b}, 300).found);     // the shift is out of the range
  EXPECT_FALSE(align({0, a}, {9000, b}, 300).found);  // only a tenth overlaps
  const std::vector<double> still(10000, 0.0);
  EXPECT_FALSE(align({0, a}, {0, still}, 300).found);
}

}  // namespace
}  // namespace tacto::spatial

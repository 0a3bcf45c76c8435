// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/clock_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace tacto::schema {
namespace {

std::vector<ClockPair> pairs(double seconds, double ppm, double late_s, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> late(0, late_s);
  std::vector<ClockPair> made;
  for (int i = 0; i <= seconds; ++i)
    made.push_back({static_cast<std::uint64_t>(i), 5 + i * (1 + ppm * 1e-6), 86400.0 + i + late(random)});
  return made;
}

TEST(ClockFit, FindsAClockThatIsFastToTheDigit) {
  const auto fit = fit_clock(pairs(20, 35, 0, 1));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->drift_ppm, 35, 1e-5);  // host times have 16 digits: 1e-11 s of 20 s
  EXPECT_NEAR(fit->offset_s, 5 - 86400, 1e-9);
  EXPECT_LT(fit->drift_uncertainty_ppm, 1e-4);
}

// Messages that are late by up to 2 ms: the true value is within two standard uncertainties about as often as
// stated.
TEST(ClockFit, ItsUncertaintyHoldsTheTruth) {
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const auto fit = fit_clock(pairs(60, -80, 2e-3, seed));
    ASSERT_TRUE(fit);
    inside += std::abs(fit->drift_ppm + 80) <= 2.0 * fit->drift_uncertainty_ppm ? 1 : 0;
    EXPECT_NEAR(fit->scatter_s, 2e-3 / std::sqrt(12), 2e-4);
  }
  EXPECT_GT(inside, 460);  // 95 % of 500 are 475 +- 5
  EXPECT_LT(inside, 492);
}

TEST(ClockFit, TooShortIsNone) {
  EXPECT_FALSE(fit_clock(pairs(9, 35, 0, 1)));
  EXPECT_FALSE(fit_clock({}));
  const std::vector<ClockPair> two = {{0, 0, 0}, {1, 100, 100}};
  EXPECT_FALSE(fit_clock(two));
  const std::vector<ClockPair> broken = {{0, 0, 0}, {1, NAN, 5}, {2, 20, 20}};
  EXPECT_FALSE(fit_clock(broken));
}

}  // namespace
}  // namespace tacto::schema

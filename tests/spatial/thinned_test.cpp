// SPDX-License-Identifier: GPL-3.0-or-later
// Decimation: frequencies that the result can represent are kept, others are removed without aliases.
#include "spatial/dsp/resample/thinned.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tacto::spatial {
namespace {

std::vector<double> tone(double cycles_a_sample, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] = std::sin(2 * std::numbers::pi * cycles_a_sample * static_cast<double>(i));
  return values;
}

// The largest difference away from the ends, where the filter lacks samples.
double difference(std::span<const double> a, std::span<const double> b) {
  double largest = 0;
  for (std::size_t i = 50; i + 50 < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(Thinned, KeepsWhatTheFewerSamplesHold) {
  for (const std::size_t n : {2U, 3U, 10U, 80U}) {
    const double cycles = 0.39 / static_cast<double>(n);
    const auto kept = thinned(tone(cycles, 400 * n), n);
    ASSERT_EQ(kept.size(), 400U);
    EXPECT_LT(difference(kept, tone(cycles * static_cast<double>(n), 400)), 1e-6) << n;
  }
}

TEST(Thinned, LetsNothingFold) {
  for (const std::size_t n : {2U, 3U, 10U, 80U})
    for (const double of_kept_rate : {0.61, 0.9, 1.0}) {
      const auto kept = thinned(tone(of_kept_rate / static_cast<double>(n), 400 * n), n);
      EXPECT_LT(difference(kept, std::vector<double>(400)), 1e-6) << n << " " << of_kept_rate;
    }
}

TEST(Thinned, KeepsALevelToItsEndsAndCountsLikeAGrid) {
  EXPECT_EQ(thinned(std::vector<double>{1, 2, 3}, 1), (std::vector<double>{1, 2, 3}));
  const auto level = thinned(std::vector<double>(31, 2.5), 10);
  ASSERT_EQ(level.size(), 4U);
  for (const double value : level) EXPECT_NEAR(value, 2.5, 1e-12);
}

}  // namespace
}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/known_band.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "spatial/dsp/spectrum/window.hpp"

namespace tacto::spatial {
namespace {

using schema::BandPoint;

const std::vector<BandPoint> kKnownBand = {
    {0, 100, 9000}, {10e-3, 300, 9000}, {20e-3, 300, 5000}, {40e-3, 500, 5000}};

TEST(KnownBand, IsTheNarrowestAlongTheStretch) {
  // Between breakpoints the limits are linear: 200 at 5 mm, 7000 at 15 mm.
  const auto rising = band_along(kKnownBand, 2e-3, 5e-3);
  EXPECT_NEAR(rising.low_per_m, 200, 1e-9);
  EXPECT_NEAR(rising.high_per_m, 9000, 1e-9);
  const auto falling = band_along(kKnownBand, 8e-3, 15e-3);
  EXPECT_NEAR(falling.low_per_m, 300, 1e-9);
  EXPECT_NEAR(falling.high_per_m, 7000, 1e-9);
  const auto all = band_along(kKnownBand, -1, 1);
  EXPECT_NEAR(all.low_per_m, 500, 1e-9);
  EXPECT_NEAR(all.high_per_m, 5000, 1e-9);
}

TEST(KnownBand, FindsAPeakBetweenTheEnds) {
  const std::vector<BandPoint> slow = {{0, 100, 9000}, {5e-3, 900, 90000}, {10e-3, 100, 9000}};
  EXPECT_NEAR(band_along(slow, 1e-3, 9e-3).low_per_m, 900, 1e-9);
}

// Compared with a test of every position of a fine grid.
TEST(KnownBand, AgreesWithALookAtEachPosition) {
  const std::vector<double> centres = {0, 4e-3, 9.9e-3, 17e-3, 39e-3, 50e-3};
  const auto known = known_bands(kKnownBand, centres, 10e-3);
  ASSERT_EQ(known.size(), centres.size());
  for (std::size_t p = 0; p < centres.size(); ++p) {
    double low = 0, high = INFINITY;
    for (int i = -1960; i <= 1960; ++i) {
      const auto at = band_along(kKnownBand, centres[p] + i * 1e-6, centres[p] + i * 1e-6);
      low = std::max(low, at.low_per_m);
      high = std::min(high, at.high_per_m);
    }
    EXPECT_NEAR(known[p].low_per_m, low, 1e-9) << p;
    EXPECT_NEAR(known[p].high_per_m, high, 1e-9) << p;
  }
  EXPECT_TRUE(known_bands({}, centres, 10e-3).empty());
}

TEST(KnownBand, AsksForThePartThatCarriesNineTenthsOfThePower) {
  auto weights = blackman(100000);
  for (double& w : weights) w *= w;
  const auto reach = static_cast<std::ptrdiff_t>(kKnownPart / 2 * 100000);
  const double part = std::accumulate(weights.begin() + 50000 - reach, weights.begin() + 50000 + reach, 0.0);
  EXPECT_NEAR(part / std::accumulate(weights.begin(), weights.end(), 0.0), 0.9, 1e-3);
}

TEST(KnownBand, CellsBelongToItWithBothEnds) {
  schema::Spectrogram spectrogram;
  spectrogram.bins = 5;
  spectrogram.frequency_step_per_m = 100;
  spectrogram.position_m = {0, 1};
  EXPECT_TRUE(spectrogram.knows(1, 4));  // without an entry everything is known
  spectrogram.known = {{100, 300}, {300, 100}};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(spectrogram.knows(0, k), k >= 1 && k <= 3) << k;
    EXPECT_FALSE(spectrogram.knows(1, k));
  }
}

}  // namespace
}  // namespace tacto::spatial

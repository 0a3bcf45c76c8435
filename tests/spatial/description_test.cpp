// SPDX-License-Identifier: GPL-3.0-or-later
// Standard descriptions against closed forms; description_scipy_test.py compares them with SciPy.
#include "spatial/features/description.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/spatial/simulated_strokes.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

using schema::Description;
using schema::ErrorKind;
using schema::ThirdOctaveBand;

schema::Texture white(std::size_t count, double pitch_m) {
  samples::Dice dice(4);
  std::vector<double> values(count);
  for (double& value : values) value = dice.normal();
  return samples::texture_of(std::move(values), pitch_m);
}

double power_of_band(const std::vector<ThirdOctaveBand>& bands) {
  double power = 0;
  for (const auto& band : bands) power += band.rms * band.rms;
  return power;
}

TEST(Description, ASineIsAllInItsOwnBand) {
  DescriptionOptions options;
  options.window_m = 20e-3;
  const auto made = describe(samples::sine(0.02, 2000, 100000), options);
  ASSERT_TRUE(made);
  EXPECT_NEAR(made->rms, 0.02 / std::sqrt(2), 1e-6);
  EXPECT_NEAR(made->centroid_per_m, 2000, 0.01);
  for (const auto& band : made->bands)
    if (band.number == 3) {
      EXPECT_NEAR(band.centre_per_m, 1995.262, 0.001);  // 10^0.3 /mm
      EXPECT_NEAR(band.rms, 0.02 / std::sqrt(2), 1e-6);
      EXPECT_FALSE(band.partial);
    } else {
      EXPECT_LT(band.rms, 1e-4) << band.number;
    }
}

// Bands cover the valid band without gap or overlap, so their powers sum to the RMS, to rounding.
TEST(Description, BandsSumToTheRms) {
  auto texture = white(50000, 2e-6);
  texture.valid_band = {{0, 375, 12500}, {0.05, 410, 13000}, {0.1, 375, 12500}};
  const auto made = describe(texture);
  ASSERT_TRUE(made);
  EXPECT_DOUBLE_EQ(made->low_per_m, 410);
  EXPECT_DOUBLE_EQ(made->high_per_m, 12500);
  EXPECT_NEAR(power_of_band(made->bands), made->rms * made->rms, 1e-12);
  EXPECT_TRUE(made->bands.front().partial);
  EXPECT_TRUE(made->bands.back().partial);
  for (std::size_t i = 1; i + 1 < made->bands.size(); ++i) {
    EXPECT_FALSE(made->bands[i].partial);
    EXPECT_NEAR(made->bands[i].high_per_m, made->bands[i + 1].low_per_m, 1e-9);
  }
}

// Parseval: the first and last half window have less weight (2 windows in about 200), and frequencies below
// 1.5 / window (0.6 % of the band here) are excluded.
TEST(Description, TheWholeBandHoldsTheSamplesPower) {
  DescriptionOptions options;
  options.window_m = 1e-3;
  const auto made = describe(white(100000, 2e-6), options);
  ASSERT_TRUE(made);
  EXPECT_NEAR(made->rms / made->total_rms, 1, 0.01);
  EXPECT_NEAR(made->total_rms, 1, 0.01);
}

// White noise: density 2 pitch, slope 0, centroid in the middle of the band. Tolerance: scatter by the number
// of windows; 5 seeds of a wide band.
TEST(Description, WhiteNoiseHasNoSlope) {
  auto texture = white(500000, 2e-6);
  texture.valid_band = {{0, 400, 100e3}};
  const auto made = describe(texture);
  ASSERT_TRUE(made);
  EXPECT_NEAR(made->slope_db_per_octave, 0, 0.1);
  EXPECT_NEAR(made->centroid_per_m, 50.2e3, 500);
  EXPECT_NEAR(made->rms, std::sqrt(2 * 2e-6 * 99.6e3), 0.005);
}

// A random walk's density falls by 20 dB per decade, 6.02 dB per octave, far below half the sampling
// frequency.
TEST(Description, ARandomWalkFallsBySixDecibelsAnOctave) {
  auto texture = white(500000, 2e-6);
  double sum = 0;
  for (double& value : texture.signal.values) value = sum += value;
  texture.valid_band = {{0, 200, 20e3}};
  const auto made = describe(texture);
  ASSERT_TRUE(made);
  EXPECT_NEAR(made->slope_db_per_octave, -6.02, 0.15);
}

TEST(Description, SilenceHasNoCentroid) {
  const auto made = describe(samples::texture_of(std::vector<double>(10000, 0.0)));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->rms, 0);
  EXPECT_TRUE(std::isnan(made->centroid_per_m));
  EXPECT_TRUE(std::isnan(made->slope_db_per_octave));
}

TEST(Description, RefusesWhatItCantDescribe) {
  auto texture = white(10000, 2e-6);
  DescriptionOptions options;
  for (const double bad : {0.0, 1e-6, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options.window_m = bad;
    EXPECT_EQ(describe(texture, options).error().kind, ErrorKind::usage) << bad;
  }
  texture.valid_band = {{0, 400, 410}, {0.01, 405, 415}, {0.02, 412, 420}};
  EXPECT_EQ(describe(texture).error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(describe(samples::noise(5)).error().kind, ErrorKind::unsuitable);
}

}  // namespace
}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "spatial/spectrogram_summary.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

using schema::Fault;

// Cells are stored as float: 2^-24 of each; sums of thousands of them stay under this.
constexpr double kFloat = 1e-6;

SpectrogramOptions everything() {
  SpectrogramOptions options;
  options.max_frequency_per_m = 1e9;
  return options;
}

double blackman(double n, double length) {
  const double phase = 2 * std::numbers::pi * n / length;
  return 0.42 - 0.5 * std::cos(phase) + 0.08 * std::cos(2 * phase);
}

TEST(Spectrogram, HasTheDefaultsOfThePaper) {
  const auto result = spatial_spectrogram(samples::noise(30000), {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->padded_samples, 16384U);
  EXPECT_EQ(result->bins, 246U);  // 15/mm * 16384 um = 245.76
  EXPECT_DOUBLE_EQ(result->frequency_step_per_m, 1e6 / 16384);
  ASSERT_EQ(result->position_m.size(), 201U);
  EXPECT_DOUBLE_EQ(result->position_m.front(), 5e-3);
  EXPECT_NEAR(result->position_m.back(), 25e-3, 1e-12);
  EXPECT_EQ(result->detrend, "constant");
}

// A window that holds whole periods, without zeros after it: the sine falls in three bins of the Blackman
// window, whose sum is A^2 / 2 by Parseval.
TEST(Spectrogram, IntegratesASineToHalfItsSquare) {
  constexpr double kAmplitude = 0.02;
  SpectrogramOptions options = everything();
  options.padded_m = options.window_m;
  const auto result = spatial_spectrogram(samples::sine(kAmplitude, 1000, 12000), options);
  ASSERT_TRUE(result);
  const double rms = band_rms(*result, 0);
  EXPECT_NEAR(rms * rms, kAmplitude * kAmplitude / 2, kFloat * kAmplitude * kAmplitude);
  const SpectralPeak peak = strongest_peak(*result, 0);
  EXPECT_NEAR(peak.frequency_per_m, 1000, 1e-6);
  // At its centre: c A^2 / 4 (sum w)^2 pitch / sum w^2, with the window's sums 0.42 W and 0.3046 W.
  const double expected = 2 * kAmplitude * kAmplitude / 4 * 0.42 * 0.42 / 0.3046 * options.window_m;
  EXPECT_NEAR(peak.cell, expected, kFloat * expected);
}

// Each row's integral is the power of its weighted samples, with and without zeros after them, even or odd in
// number.
TEST(Spectrogram, KeepsEnergyByParseval) {
  const auto texture = samples::noise(1500);
  for (const double padded_m : {1000e-6, 1024e-6, 1501e-6}) {
    SpectrogramOptions options = everything();
    options.window_m = 1e-3;
    options.hop_m = 0.25e-3;
    options.padded_m = padded_m;
    options.detrend = Detrend::none;
    const auto result = spatial_spectrogram(texture, options);
    ASSERT_TRUE(result);
    ASSERT_EQ(result->position_m.size(), 3U);
    for (std::size_t p = 0; p < 3; ++p) {
      double integral = 0, weighted = 0, weights = 0;
      for (std::size_t k = 0; k < result->bins; ++k) integral += static_cast<double>(result->at(p, k));
      integral *= result->frequency_step_per_m;
      for (std::size_t n = 0; n < 1000; ++n) {
        const double w = blackman(static_cast<double>(n), 1000);
        weighted += std::pow(w * texture.signal.values[p * 250 + n], 2);
        weights += w * w;
      }
      EXPECT_NEAR(integral, weighted / weights, kFloat * weighted / weights) << padded_m;
    }
  }
}

// The plain sum of the definition, in long double, at a few cells.
TEST(Spectrogram, AgreesWithItsDefinition) {
  const auto texture = samples::noise(700, 10e-6);
  SpectrogramOptions options = everything();
  options.window_m = 3e-3;
  options.hop_m = 1e-3;
  const auto result = spatial_spectrogram(texture, options);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->padded_samples, 512U);
  for (const std::size_t k : {0U, 1U, 17U, 255U, 256U}) {
    const std::size_t p = 2;
    long double mean = 0, real = 0, imaginary = 0, weights = 0;
    for (std::size_t n = 0; n < 300; ++n) mean += texture.signal.values[p * 100 + n] / 300;
    for (std::size_t n = 0; n < 300; ++n) {
      const long double w = blackman(static_cast<double>(n), 300);
      const long double phase = 2 * std::numbers::pi_v<long double> * static_cast<long double>(k * n) / 512;
      real += w * (texture.signal.values[p * 100 + n] - mean) * std::cos(phase);
      imaginary -= w * (texture.signal.values[p * 100 + n] - mean) * std::sin(phase);
      weights += w * w;
    }
    const bool alone = k == 0 || k == 256;
    const long double expected = (alone ? 1 : 2) * (real * real + imaginary * imaginary) * 10e-6L / weights;
    EXPECT_NEAR(result->at(p, k), static_cast<double>(expected), 1e-6 * static_cast<double>(expected)) << k;
  }
}

TEST(Spectrogram, TakesTheMeanOffOnlyWhereAsked) {
  auto texture = samples::noise(12000);
  SpectrogramOptions options;
  const auto plain = spatial_spectrogram(texture, options);
  for (double& value : texture.signal.values) value += 100;
  const auto lifted = spatial_spectrogram(texture, options);
  options.detrend = Detrend::none;
  const auto kept = spatial_spectrogram(texture, options);
  ASSERT_TRUE(plain && lifted && kept);
  // A constant of 100 costs the samples 7 of their 53 bits.
  for (std::size_t i = 0; i < plain->cells.size(); ++i)
    ASSERT_NEAR(lifted->cells[i], plain->cells[i], 1e-6F * plain->cells[i] + 1e-15F);
  EXPECT_GT(kept->at(0, 0), 1e4F * plain->at(0, 3));
}

TEST(Spectrogram, PositionsStartAtTheTexturesOrigin) {
  auto texture = samples::noise(20000);
  texture.signal.origin_m = 0.5;
  const auto result = spatial_spectrogram(texture, {});
  ASSERT_TRUE(result);
  EXPECT_DOUBLE_EQ(result->position_m.front(), 0.505);
}

TEST(Spectrogram, TakesTheShortestTextureThatHoldsAWindow) {
  const auto result = spatial_spectrogram(samples::noise(10000), {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->position_m.size(), 1U);
  const auto refused = spatial_spectrogram(samples::noise(9999), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::unsuitable);
  EXPECT_EQ(refused.error().remedy, "a window of 9.99 mm would fit");
  SpectrogramOptions options;
  options.window_m = 9.99e-3;
  EXPECT_TRUE(spatial_spectrogram(samples::noise(9999), options));
}

TEST(Spectrogram, RefusesImpossibleOptions) {
  const auto texture = samples::noise(20000);
  const auto fault_of = [&](auto change) {
    SpectrogramOptions options;
    change(options);
    const auto result = spatial_spectrogram(texture, options);
    return result ? Fault::internal : result.error().fault;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1e-3, 7e-6, 1e300, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.window_m = bad; }), Fault::usage) << bad;
  for (const double bad : {0.0, -1e-3, 0.4e-6, 1e300, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.hop_m = bad; }), Fault::usage) << bad;
  for (const double bad : {0.0, 9e-3, 1e300, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.padded_m = bad; }), Fault::usage) << bad;
  for (const double bad : {0.0, -1.0, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.max_frequency_per_m = bad; }), Fault::usage) << bad;
}

TEST(Spectrogram, NamesTheSampleThatIsNotFinite) {
  auto texture = samples::noise(20000);
  texture.signal.values[4321] = std::numeric_limits<double>::infinity();
  const auto result = spatial_spectrogram(texture, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where, "sample 4321");
}

TEST(Spectrogram, ReportsProgressToTheEnd) {
  double last = 0;
  ASSERT_TRUE(spatial_spectrogram(samples::noise(20000), {}, [&](double part) {
    EXPECT_GT(part, last);
    last = part;
  }));
  EXPECT_DOUBLE_EQ(last, 1);
}

TEST(SpectrogramSummary, LevelsNameTheirReference) {
  schema::Spectrogram spectrogram;
  spectrogram.unit = "N";
  EXPECT_EQ(level_reference(spectrogram).unit, "1 N^2 mm");
  EXPECT_DOUBLE_EQ(level_db(1e-3, level_reference(spectrogram)), 0);  // 1e-3 N^2 m is 1 N^2 mm
  spectrogram.unit = "m";
  EXPECT_EQ(level_reference(spectrogram).unit, "1 um^2 mm");
  EXPECT_NEAR(level_db(1e-12, level_reference(spectrogram)), 30, 1e-9);  // 1e-12 m^2 m is 1000 um^2 mm
}

TEST(SpectrogramSummary, MeanIsOverPositions) {
  schema::Spectrogram spectrogram;
  spectrogram.bins = 2;
  spectrogram.position_m = {1, 2};
  spectrogram.cells = {1, 10, 3, 30};
  EXPECT_EQ(mean_spectrum(spectrogram), (std::vector<double>{2, 20}));
}

}  // namespace
}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/spectrogram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "spatial/spectrogram/spectrogram_maker.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"
#include "spatial/spectrogram/spectrogram_tally.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;

// Cells are stored as float: 2^-24 of each; sums of thousands of them stay under this.
constexpr double kFloat = 1e-6;

SpectrogramOptions everything() {
  SpectrogramOptions options;
  options.max_frequency_per_m = 1e9;
  return options;
}

double exact_blackman(double n, double length) {
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

// A window with whole periods and without padding: the sine is in three bins of the Blackman window, whose
// sum is A^2 / 2 by Parseval.
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
        const double w = exact_blackman(static_cast<double>(n), 1000);
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
      const long double w = exact_blackman(static_cast<double>(n), 300);
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
  // A constant of 100 reduces the precision of the samples by 7 of their 53 bits.
  for (std::size_t i = 0; i < plain->cells.size(); ++i)
    ASSERT_NEAR(lifted->cells[i], plain->cells[i], 1e-6F * plain->cells[i] + 1e-15F);
  EXPECT_GT(kept->at(0, 0), 1e4F * plain->at(0, 3));
}

TEST(Spectrogram, AmplitudesOfASineAreItsOwn) {
  constexpr double kAmplitude = 0.02;
  for (const double highest : {15e3, 1e9})
    for (const double size : {1e-30, 1.0, 1e30}) {
      SpectrogramOptions options;
      options.padded_m = options.window_m;  // the sine is at the centre of a bin
      options.scaling = schema::Scaling::amplitude;
      options.max_frequency_per_m = highest;
      const auto result = spatial_spectrogram(samples::sine(kAmplitude * size, 2000, 12000), options);
      ASSERT_TRUE(result);
      const SpectralPeak peak = strongest_peak(*result, 0);
      EXPECT_NEAR(peak.frequency_per_m, 2000, 1e-6);
      EXPECT_NEAR(peak.cell, kAmplitude * size, kFloat * kAmplitude * size);
      EXPECT_NEAR(band_rms(*result, 0), kAmplitude * size / std::sqrt(2), kFloat * kAmplitude * size);
    }
}

// Both agree: A^2 / 2 over the window's noise bandwidth.
TEST(Spectrogram, DensitiesAndAmplitudesAgree) {
  const auto texture = samples::noise(1500);
  SpectrogramOptions options = everything();
  options.window_m = 1e-3;
  options.hop_m = 0.1e-3;
  options.padded_m = 1e-3;
  const auto density = spatial_spectrogram(texture, options);
  options.scaling = schema::Scaling::amplitude;
  const auto amplitude = spatial_spectrogram(texture, options);
  ASSERT_TRUE(density && amplitude);
  EXPECT_EQ(amplitude->coherent_gain, 0.42);
  const double largest = strongest_peak(*density, 0).cell;
  for (std::size_t p = 0; p < density->position_m.size(); ++p)
    for (std::size_t k = 0; k < density->bins; ++k) {
      const double expected = density->at(p, k), got = power_of(*amplitude, k, amplitude->at(p, k));
      ASSERT_NEAR(std::sqrt(got), std::sqrt(expected), kFloat * std::sqrt(largest));  // -120 dB
    }
  EXPECT_NEAR(band_rms(*amplitude, 1000), band_rms(*density, 1000), kFloat * band_rms(*density, 1000));
}

TEST(Spectrogram, DensitiesBeyondSinglePrecisionAreRefused) {
  const auto refused = spatial_spectrogram(samples::sine(1e30, 2000, 12000), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_NE(refused.error().remedy.find("--scaling"), std::string::npos);
}

// 1e-30 squared is below single precision: all cells would be zero without a message.
TEST(Spectrogram, DensitiesBelowSinglePrecisionAreRefusedToo) {
  const auto refused = spatial_spectrogram(samples::sine(1e-30, 2000, 12000), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  SpectrogramOptions amplitudes;
  amplitudes.scaling = schema::Scaling::amplitude;
  const auto shown = spatial_spectrogram(samples::sine(1e-30, 2000, 12000), amplitudes);
  ASSERT_TRUE(shown);
  EXPECT_NEAR(strongest_peak(*shown, 0).cell / 1e-30, 1, 0.02);  // the line is beside its bin
  EXPECT_TRUE(spatial_spectrogram(samples::sine(0, 2000, 12000), {}));
}

TEST(Spectrogram, ACoarserGridGivesTheSameCells) {
  auto texture = samples::sine(0.02, 2345, 45000);
  const auto noise = samples::noise(45000);
  for (std::size_t i = 0; i < 45000; ++i) texture.signal.values[i] += 1e-3 * noise.signal.values[i];
  SpectrogramOptions options;
  const auto coarse = spatial_spectrogram(texture, options);
  options.resolution = Resolution::whole;
  const auto whole = spatial_spectrogram(texture, options);
  ASSERT_TRUE(coarse && whole);
  EXPECT_EQ(coarse->decimation, 16U);
  EXPECT_EQ(whole->decimation, 1U);
  ASSERT_EQ(coarse->cells.size(), whole->cells.size());
  const double largest = std::sqrt(strongest_peak(*whole, 0).cell);
  // Both are exact to -120 dB of the largest.
  for (std::size_t i = 0; i < whole->cells.size(); ++i)
    ASSERT_NEAR(std::sqrt(coarse->cells[i]), std::sqrt(whole->cells[i]), 2e-6 * largest);
}

TEST(Spectrogram, RowsComeInOrderAndOnce) {
  for (const double highest : {15e3, 1e9}) {
    SpectrogramOptions options;
    options.max_frequency_per_m = highest;
    auto maker = SpectrogramMaker::prepare(options, 1e-6, 1);
    ASSERT_TRUE(maker);
    for (const std::size_t samples : {10000U, 10099U, 10100U, 45000U, 80000U}) {
      const auto texture = samples::noise(samples);
      const auto header = maker->describe(texture);
      ASSERT_TRUE(header);
      std::size_t rows = 0;
      const auto made = maker->make(texture, [&](std::size_t first, std::span<const float> cells) {
        EXPECT_EQ(first, rows);
        EXPECT_EQ(cells.size() % header->bins, 0U);
        EXPECT_LE(cells.size(), std::size_t{1} << 17);  // half a megabyte for textures of any length
        rows += cells.size() / header->bins;
        return schema::Result<void>{};
      });
      ASSERT_TRUE(made);
      EXPECT_EQ(rows, header->position_m.size());
    }
  }
}

TEST(Spectrogram, KnowsWhatTheTextureKnew) {
  auto texture = samples::noise(40000);
  texture.valid_band = {{0, 300, 9000}, {40e-3, 300, 12000}};
  const auto result = spatial_spectrogram(texture, {});
  ASSERT_TRUE(result);
  ASSERT_EQ(result->known.size(), result->position_m.size());
  EXPECT_NEAR(result->known[0].high_per_m, 9000 + 3000 * (5 - 1.96) / 40, 1e-6);
  EXPECT_FALSE(result->knows(0, 4));
  EXPECT_TRUE(result->knows(0, 5));  // 305/m
}

TEST(Spectrogram, TakesHeightsOnAGridOfAQuarterMicrometre) {
  auto texture = samples::sine(3e-6, 40e3, 22401, 0.25e-6);
  texture.quantity = "height";
  texture.unit = "m";
  SpectrogramOptions options;
  options.window_m = 1e-3;
  options.hop_m = 10e-6;
  options.max_frequency_per_m = 100e3;
  options.scaling = schema::Scaling::amplitude;
  const auto result = spatial_spectrogram(texture, options);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->position_m.size(), 461U);
  EXPECT_EQ(result->padded_samples, 4096U);
  EXPECT_GT(result->decimation, 1U);
  const SpectralPeak peak = strongest_peak(*result, 1e3);
  EXPECT_NEAR(peak.frequency_per_m, 40e3, result->frequency_step_per_m / 2);
  EXPECT_NEAR(peak.cell, 3e-6, 0.02 * 3e-6);  // between two bins of a padded window: up to 1.5 % lower
  EXPECT_EQ(level_reference(*result).unit, "1 um");
}

TEST(SpectrogramTally, SaysWhatTheWholeSpectrogramSays) {
  auto texture = samples::noise(20000);
  for (const auto scaling : {schema::Scaling::density, schema::Scaling::amplitude}) {
    SpectrogramOptions options;
    options.scaling = scaling;
    auto whole = spatial_spectrogram(texture, options);
    ASSERT_TRUE(whole);
    // Valid bands that leave out the strongest cell, and one row without any.
    const SpectralPeak free = strongest_peak(*whole, 0);
    whole->known.assign(whole->position_m.size(), {0, 0.999 * free.frequency_per_m});
    whole->known[3] = {2, 1};
    EXPECT_LT(strongest_peak(*whole, 0).frequency_per_m, free.frequency_per_m);
    SpectrogramTally tally(*whole, 1000);
    for (std::size_t p = 0; p < whole->position_m.size(); p += 7) {
      const std::size_t rows = std::min<std::size_t>(7, whole->position_m.size() - p);
      tally.add(p, std::span(whole->cells).subspan(p * whole->bins, rows * whole->bins));
    }
    for (const double lowest : {0.0, 61.0, 500.0, 1000.0}) {
      const SpectralPeak expected = strongest_peak(*whole, lowest), got = tally.strongest_peak(lowest);
      EXPECT_EQ(got.position_m, expected.position_m);
      EXPECT_EQ(got.frequency_per_m, expected.frequency_per_m);
      EXPECT_EQ(got.cell, expected.cell);
      EXPECT_NEAR(tally.band_rms(lowest), band_rms(*whole, lowest), 1e-12 * band_rms(*whole, lowest));
    }
  }
}

TEST(SpectrogramTally, HasNoPeakOutsideTheValidBand) {
  auto whole = spatial_spectrogram(samples::noise(20000), {});
  ASSERT_TRUE(whole);
  whole->known.assign(whole->position_m.size(), {2, 1});
  SpectrogramTally tally(*whole, 1000);
  tally.add(0, whole->cells);
  EXPECT_TRUE(std::isnan(strongest_peak(*whole, 0).cell));
  EXPECT_TRUE(std::isnan(tally.strongest_peak(0).frequency_per_m));
  EXPECT_GT(tally.band_rms(0), 0);
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
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(refused.error().remedy, "use a window of 9.99 mm or less");
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
    return result ? ErrorKind::internal : result.error().kind;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1e-3, 7e-6, 1e300, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.window_m = bad; }), ErrorKind::usage) << bad;
  for (const double bad : {0.0, -1e-3, 0.4e-6, 1e300, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.hop_m = bad; }), ErrorKind::usage) << bad;
  for (const double bad : {0.0, 9e-3, 1e300, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.padded_m = bad; }), ErrorKind::usage) << bad;
  SpectrogramOptions far;
  far.padded_m = 100;
  EXPECT_EQ(spatial_spectrogram(texture, far).error().remedy,
            "use 10 mm (the window) to 16.78 m (2^24 samples)");
  for (const double bad : {0.0, -1.0, kNan})
    EXPECT_EQ(fault_of([&](auto& o) { o.max_frequency_per_m = bad; }), ErrorKind::usage) << bad;
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

// SPDX-License-Identifier: GPL-3.0-or-later
// Formants of textures with known lines, and of noise, which has none.
#include "spatial/features/formants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "spatial/spectrogram/spectrogram.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"
#include "tests/measured.hpp"
#include "tests/sanitized.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

using schema::Formant;

constexpr double kPitch_m = 10e-6;
constexpr double kWindow_m = 10e-3;
constexpr double kBin_per_m = 1 / kWindow_m;  // of the unpadded window

// White noise of RMS 1: its density is 2 * pitch. std::normal_distribution differs between libraries.
std::vector<double> white_noise(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto even = [&] { return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53; };
  std::vector<double> values(count);
  for (double& value : values)
    value = std::sqrt(-2 * std::log(even())) * std::cos(2 * std::numbers::pi * even());
  return values;
}

// Amplitude of a line whose peak exceeds white noise of RMS 1 by this prominence: its density there is A^2 /
// 2 (sum w)^2 pitch / sum w^2, with the window's sums 0.42 W and 0.3046 W.
double amplitude_over_noise(double prominence_db) {
  const double density = 2 * kPitch_m * std::pow(10, prominence_db / 10);
  return std::sqrt(density * 2 * 0.3046 / (0.42 * 0.42 * kWindow_m));
}

std::vector<Formant> formants_of(std::vector<double> values, const FormantOptions& options = {}) {
  const auto texture = samples::texture_of(std::move(values), kPitch_m);
  SpectrogramOptions spectrogram;
  spectrogram.padded_m = 16.384e-3;
  const auto made = spatial_spectrogram(texture, spectrogram);
  EXPECT_TRUE(made);
  const auto found = find_formants(*made, options);
  EXPECT_TRUE(found);
  return *found;
}

double position_of(std::size_t i) {
  return static_cast<double>(i) * kPitch_m;
}

// Adds amplitude(x) sin(phase(x)).
template <class Amplitude, class Phase>
void add_line(std::vector<double>& values, Amplitude amplitude, Phase phase) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += amplitude(position_of(i)) * std::sin(phase(position_of(i)));
}

double turn(double cycles) {
  return 2 * std::numbers::pi * cycles;
}

TEST(Formants, FindASteadyLine) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const double k = 900 + 613.7 * static_cast<double>(seed);
    auto values = white_noise(10000, seed);
    add_line(
        values, [](double) { return amplitude_over_noise(20); }, [&](double x) { return turn(k * x); });
    const auto found = formants_of(std::move(values));
    ASSERT_EQ(found.size(), 1U) << seed;
    worst = std::max(worst, std::abs(found[0].frequency_per_m - k) / kBin_per_m);
    EXPECT_TRUE(found[0].open_from && found[0].open_to);
    EXPECT_NEAR(found[0].from_m, 5e-3, 1e-9);
    EXPECT_NEAR(found[0].to_m, 95e-3, 1e-3);
    // Half-power width of a Blackman window: 1.64 bins; noise 20 dB below it changes it by a tenth of its
    // amplitude.
    EXPECT_NEAR(found[0].width_per_m, 1.64 * kBin_per_m, 0.16 * kBin_per_m);
    EXPECT_NEAR(found[0].prominence_db, 20, 1.5);
  }
  std::printf("steady line 20 dB over noise: mean frequency within %.3f of a bin\n", worst);
  measured("spatial_formants.steady_line_bins", worst);
  EXPECT_LT(worst, 0.02);
}

TEST(Formants, MeasureTheLevelOfASine) {
  const double k = 40 * 1e3 / 16.384;
  const auto texture = samples::sine(0.02, k, 10000, kPitch_m);
  SpectrogramOptions options;
  options.padded_m = 16.384e-3;
  const auto made = spatial_spectrogram(texture, options);
  const auto found = find_formants(*made);
  ASSERT_TRUE(found);
  ASSERT_GE(found->size(), 1U);
  const double density = 0.02 * 0.02 / 2 * 0.42 * 0.42 / 0.3046 * kWindow_m;
  EXPECT_NEAR(found->front().level_db, level_db(density, level_reference(*made)), 0.02);
  EXPECT_NEAR(found->front().frequency_per_m, k, 0.01 * kBin_per_m);
}

TEST(Formants, FollowAGlidingLine) {
  auto values = white_noise(10000, 7);
  // k(x) = 1000 + 40000 x: 1 to 5 /mm over 100 mm.
  add_line(
      values, [](double) { return amplitude_over_noise(20); },
      [](double x) { return turn(1000 * x + 20000 * x * x); });
  const auto found = formants_of(std::move(values));
  ASSERT_EQ(found.size(), 1U);
  double worst = 0;
  for (const auto& point : found[0].track)
    worst = std::max(worst, std::abs(point.frequency_per_m - (1000 + 40000 * point.position_m)));
  std::printf("gliding line 20 dB over noise: each point within %.2f of a bin\n", worst / kBin_per_m);
  measured("spatial_formants.gliding_line_bins", worst / kBin_per_m);
  EXPECT_LT(worst, 0.6 * kBin_per_m);
  EXPECT_GT(found[0].to_m - found[0].from_m, 85e-3);
}

TEST(Formants, MeasureTheExtentOfALineThatBeginsAndEndsAtOnce) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const double from = 20e-3 + 0.71e-3 * static_cast<double>(seed), to = from + 30e-3;
    auto values = white_noise(10000, 100 + seed);
    add_line(
        values, [&](double x) { return x >= from && x < to ? amplitude_over_noise(20) : 0; },
        [](double x) { return turn(3000 * x); });
    const auto found = formants_of(std::move(values));
    ASSERT_EQ(found.size(), 1U) << seed;
    worst = std::max({worst, std::abs(found[0].from_m - from), std::abs(found[0].to_m - to)});
    EXPECT_FALSE(found[0].open_from || found[0].open_to);
  }
  std::printf("line of 30 mm, 20 dB over noise: ends within %.3f of the window\n", worst / kWindow_m);
  EXPECT_LT(worst, 0.15 * kWindow_m);
}

TEST(Formants, FindTwoLinesAndWhereTheyFade) {
  auto values = white_noise(10000, 3);
  // One fades in and out over the whole length, one exists in the middle.
  add_line(
      values, [](double x) { return amplitude_over_noise(24) * std::sin(std::numbers::pi * x / 0.1); },
      [](double x) { return turn(2000 * x); });
  add_line(
      values, [](double x) { return std::abs(x - 0.05) < 0.02 ? amplitude_over_noise(30) : 0; },
      [](double x) { return turn(2600 * x); });
  const auto found = formants_of(std::move(values));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].frequency_per_m, 2600, 0.05 * kBin_per_m);
  EXPECT_NEAR(found[0].from_m, 30e-3, 0.15 * kWindow_m);
  EXPECT_NEAR(found[0].to_m, 70e-3, 0.15 * kWindow_m);
  EXPECT_NEAR(found[1].frequency_per_m, 2000, 0.1 * kBin_per_m);
  EXPECT_LT(found[1].from_m, 20e-3);
  EXPECT_GT(found[1].to_m, 80e-3);
}

TEST(Formants, BridgeAShortDropout) {
  auto values = white_noise(10000, 11);
  add_line(
      values, [](double x) { return std::abs(x - 0.05) < 0.002 ? 0 : amplitude_over_noise(16); },
      [](double x) { return turn(4000 * x); });
  EXPECT_EQ(formants_of(values).size(), 1U);
  FormantOptions strict;
  strict.bridge_m = 0;
  EXPECT_GT(formants_of(values, strict).size(), 1U);
}

// 40 textures of 250 mm: together about 200,000 independent cells up to 15 /mm.
TEST(Formants, NoiseHasNone) {
  std::size_t alarms = 0;
  const int count = draws(40, 4);
  for (int seed = 0; seed < count; ++seed) alarms += formants_of(white_noise(25000, 1000 + seed)).size();
  std::printf("white noise: %zu false alarms in %g m of texture, up to 15 /mm\n", alarms, 0.25 * count);
  measured("spatial_formants.noise_m", 0.25 * count);
  measured("spatial_formants.noise_alarms", static_cast<double>(alarms));
  EXPECT_LE(alarms, 1U);
}

// Noise that falls with frequency and whose level changes along the texture has none either.
TEST(Formants, ColouredAndUnevenNoiseHasNone) {
  std::size_t alarms = 0;
  const int count = draws(20, 4);
  for (int seed = 0; seed < count; ++seed) {
    auto values = white_noise(25000, 2000 + seed);
    double slow = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      slow += 0.02 * (values[i] - slow);  // corner at 0.3 /mm: 6 dB an octave above
      values[i] = slow * (i > 12000 && i < 18000 ? 6 : 1);
    }
    alarms += formants_of(std::move(values)).size();
  }
  std::printf("coloured, uneven noise: %zu false alarms in %g m of texture\n", alarms, 0.25 * count);
  EXPECT_LE(alarms, 2U);
}

// A line outside of the valid band is not measured, so it is no formant.
TEST(Formants, AreFoundOnlyWhereTheBandIsValid) {
  auto values = white_noise(10000, 5);
  add_line(
      values, [](double) { return amplitude_over_noise(25); }, [](double x) { return turn(3000 * x); });
  auto texture = samples::texture_of(std::move(values), kPitch_m);
  // The finger slows down at 50 mm; from there on 3 /mm is below the band.
  texture.valid_band = {{0, 400, 12e3}, {0.05, 400, 12e3}, {0.05, 4000, 120e3}, {0.1, 4000, 120e3}};
  const auto found = find_formants(*spatial_spectrogram(texture, {}));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1U);
  EXPECT_NEAR(found->front().to_m, 0.048, 0.2e-3);  // the last window with its centre before it
  texture.valid_band = {{0, 4000, 12e3}};
  EXPECT_TRUE(find_formants(*spatial_spectrogram(texture, {}))->empty());
}

TEST(Formants, SilenceHasNone) {
  EXPECT_TRUE(formants_of(std::vector<double>(10000, 0.0)).empty());
}

TEST(Formants, RefuseOddOptions) {
  const auto made = spatial_spectrogram(samples::noise(20000), {});
  FormantOptions options;
  options.continue_db = 20;
  EXPECT_EQ(find_formants(*made, options).error().kind, schema::ErrorKind::usage);
  options = {};
  options.bridge_m = -1;
  EXPECT_EQ(find_formants(*made, options).error().kind, schema::ErrorKind::usage);
}

}  // namespace
}  // namespace tacto::spatial

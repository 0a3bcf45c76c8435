// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of force scenes in single precision against double precision, closed forms and each other.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>

#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/noise.hpp"
#include "firmware-host/core/scene/relief.hpp"
#include "firmware-host/core/scene/turn.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/relief/relief_levels.hpp"
#include "playback/render/reference/exact_noise.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::playback {
namespace {

using schema::GrooveProfile;

constexpr double kTurnRad = 2 * std::numbers::pi;

core::Q32 q32(double cells) {
  return static_cast<core::Q32>(std::floor(cells * 0x1p32));
}

// Perlin's own program prints this number.
TEST(SceneNoise, TheReferenceIsPerlinsProgram) {
  EXPECT_NEAR(exact_noise(core::kPerlinNoise, 3.14, 42, 7), 0.136919958784, 5e-13);
}

TEST(SceneNoise, SinglePrecisionIsTheReference) {
  std::mt19937_64 random(2002);
  std::uniform_real_distribution<double> cells(-1000, 1000);
  const core::NoiseTable table = core::shuffled_noise(7);
  double worst = 0, worst_slope = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = cells(random), y = cells(random), z = cells(random), h = 1e-5;
    const core::NoiseSample found = core::noise(table, q32(x), q32(y), q32(z));
    worst = std::max(worst, std::abs(found.value - exact_noise(table, x, y, z)));
    const double by_x = (exact_noise(table, x + h, y, z) - exact_noise(table, x - h, y, z)) / (2 * h);
    const double by_y = (exact_noise(table, x, y + h, z) - exact_noise(table, x, y - h, z)) / (2 * h);
    worst_slope = std::max({worst_slope, std::abs(found.by_x - by_x), std::abs(found.by_y - by_y)});
  }
  std::printf("  noise: value within %.2g, derivatives within %.2g of double precision\n", worst,
              worst_slope);
  EXPECT_LT(worst, 2e-7);
  EXPECT_LT(worst_slope, 2e-6);
}

TEST(SceneNoise, ASeedShufflesAllGradients) {
  const core::NoiseTable table = core::shuffled_noise(3);
  std::vector<int> seen(256, 0);
  int same = 0;
  for (int i = 0; i < 256; ++i) {
    ++seen[table.order[i]];
    same += table.order[i] == core::kPerlinNoise.order[i];
  }
  for (const int times : seen) EXPECT_EQ(times, 1);
  EXPECT_LT(same, 20);
  EXPECT_EQ(0, std::memcmp(&core::kPerlinNoise, core::shuffled_noise(0).order, 256));
}

TEST(SceneNoise, AFractalIsTheSumOfItsOctaves) {
  const float weights[3] = {1, 0.5F, 0.25F};
  const core::Q32 x = q32(12.3), y = q32(-4.7), z = q32(0.4);
  const core::NoiseSample sum = core::fractal_noise(core::kPerlinNoise, x, y, z, weights, 3);
  double value = 0, by_x = 0;
  for (int i = 0; i < 3; ++i) {
    const core::NoiseSample octave = core::noise(core::kPerlinNoise, x << i, y << i, z << i);
    value += weights[i] * octave.value;
    by_x += weights[i] * std::exp2(i) * octave.by_x;
  }
  EXPECT_NEAR(sum.value, value, 1e-7);
  EXPECT_NEAR(sum.by_x, by_x, 1e-6);
}

// The mean spectrum of sections of a fractal, averaged over octaves of frequency: power 2^(-(2 H + 1) octave)
// where the amplitude of octave i of the noise is 2^(-H i) (Voss 1988).
TEST(SceneNoise, ASectionOfAFractalFallsByItsRoughness) {
  constexpr std::size_t kPlaces = 8192, kPerCell = 512;
  spatial::RealFft fft(kPlaces);
  std::vector<double> section(kPlaces);
  std::vector<std::complex<double>> spectrum(fft.bins());
  for (const double h : {0.3, 0.5, 0.8}) {
    float weights[8];
    for (int i = 0; i < 8; ++i) weights[i] = static_cast<float>(std::exp2(-h * i));
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> anywhere(0, 200);
    std::vector<double> power(fft.bins());
    for (int run = 0; run < 60; ++run) {
      const double x = anywhere(random), y = anywhere(random), angle = anywhere(random);
      for (std::size_t i = 0; i < kPlaces; ++i) {
        const double along = static_cast<double>(i) / kPerCell, part = static_cast<double>(i) / kPlaces;
        section[i] = 0.5 * (1 - std::cos(kTurnRad * part)) *
                     double{core::fractal_noise(core::kPerlinNoise, q32(x + along * std::cos(angle)),
                                                q32(y + along * std::sin(angle)), 0, weights, 8)
                                .value};
      }
      fft.forward(section, spectrum);
      for (std::size_t bin = 0; bin < power.size(); ++bin) power[bin] += std::norm(spectrum[bin]);
    }
    // Octaves from 1 to 64 cycles per cell, 16 bins to a cycle; the line of least squares through their
    // means.
    double xy = 0, xx = 0;
    for (int octave = 0; octave < 6; ++octave) {
      const std::size_t from = std::size_t{16} << octave;
      double sum = 0;
      for (std::size_t bin = from; bin < 2 * from; ++bin) sum += power[bin];
      xy += (octave - 2.5) * std::log2(sum / static_cast<double>(from));
      xx += (octave - 2.5) * (octave - 2.5);
    }
    EXPECT_NEAR(xy / xx, -(2 * h + 1), 0.1) << h;
  }
}

TEST(SceneTurn, SineAndCosineWithinTheirError) {
  double worst = 0;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const auto turns = static_cast<std::uint32_t>(i * 42949);
    const auto [sine, cosine] = core::sine_cosine(turns);
    const double angle = kTurnRad * turns * 0x1p-32;
    worst = std::max({worst, std::abs(sine - std::sin(angle)), std::abs(cosine - std::cos(angle))});
  }
  EXPECT_LT(worst, 1e-7 + 0x1p-24);
}

struct Series {
  std::vector<float> amplitudes;

  Series(GrooveProfile profile, double filter_periods) {
    for (const double amplitude : groove_amplitudes(profile, filter_periods))
      amplitudes.push_back(static_cast<float>(2 * amplitude));  // from -1 to 1
  }
  operator core::Grooves() const {  // NOLINT(google-explicit-constructor): what the kernel reads
    return {amplitudes.data(), static_cast<std::uint32_t>(amplitudes.size())};
  }
};

// The sums in double precision.
core::GrooveSample in_double(const core::Grooves& g, double phase, double periods_per_tick) {
  double value = 0, slope = 0;
  for (std::uint32_t n = 1; n <= g.harmonics; ++n) {
    const double a = g.amplitude[n - 1] * core::held_by_rate(static_cast<float>(n * periods_per_tick));
    value += a * std::cos(kTurnRad * n * phase);
    slope -= a * kTurnRad * n * std::sin(kTurnRad * n * phase);
  }
  return {static_cast<float>(value), static_cast<float>(slope)};
}

TEST(SceneGrooves, ClenshawIsTheSum) {
  std::mt19937 random(5);
  for (const auto profile : {GrooveProfile::sine, GrooveProfile::triangle, GrooveProfile::square}) {
    const Series g(profile, 0.01);
    double scale = 0;
    for (std::size_t n = 1; n <= g.amplitudes.size(); ++n)
      scale += static_cast<double>(n) * std::abs(static_cast<double>(g.amplitudes[n - 1]));
    for (int i = 0; i < 2000; ++i) {
      const auto phase = static_cast<std::uint32_t>(random());
      const auto speed = static_cast<float>(i % 20) * 0.02F;
      const core::GrooveSample found = core::groove_at(g, phase, speed),
                               sum = in_double(g, phase * 0x1p-32, speed);
      EXPECT_NEAR(found.value, sum.value, 2e-7 * scale + 1e-7);
      EXPECT_NEAR(found.by_phase, sum.by_phase, kTurnRad * 4e-7 * scale + 1e-6);
    }
  }
}

TEST(SceneGrooves, ATriangleHasItsSlopeAndASquareItsSmoothedStep) {
  const Series triangle(GrooveProfile::triangle, 0.005);
  EXPECT_NEAR(core::groove_at(triangle, 1U << 30, 0).by_phase, -4, 0.01);  // 2 in half a period; 32 harmonics
  const double sigma = 0.02;
  const Series square(GrooveProfile::square, sigma);
  // A step of 2 smoothed by a Gaussian is erf; its steepest slope is 2 / (sigma sqrt(2 pi)).
  for (const double from_step : {-0.03, 0.0, 0.01}) {
    const core::GrooveSample found =
        core::groove_at(square, static_cast<std::uint32_t>((0.25 + from_step) * 0x1p32), 0);
    EXPECT_NEAR(found.value, -std::erf(from_step / (sigma * std::numbers::sqrt2)), 2e-4) << from_step;
    const double slope =
        -2 / (sigma * std::sqrt(kTurnRad)) * std::exp(-from_step * from_step / (2 * sigma * sigma));
    EXPECT_NEAR(found.by_phase, slope, 0.01) << from_step;
  }
}

TEST(SceneGrooves, NothingAboveHalfTheRateIsLeft) {
  const Series g(GrooveProfile::square, 0);
  for (std::uint32_t i = 0; i < 16; ++i) EXPECT_EQ(core::groove_at(g, i << 28, 0.5F).value, 0);
  // At 0.12 periods a tick harmonics 1 and 3 pass, 5 and above are over half the rate.
  const float a1 = g.amplitudes[0], a3 = g.amplitudes[2];
  EXPECT_NEAR(core::groove_at(g, 0, 0.12F).value, a1 + a3, 1e-6);
}

struct Map {
  std::size_t columns = 48, rows = 40;
  std::vector<double> heights;
  std::vector<float> coefficients;

  explicit Map(const std::function<double(double, double)>& height) {
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i < columns; ++i)
        heights.push_back(height(static_cast<double>(i), static_cast<double>(j)));
    coefficients = relief_coefficients(heights, columns, rows);
  }
  core::ReliefLevel level() const {
    return {coefficients.data(), static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows)};
  }
};

TEST(SceneRelief, TheSurfaceGoesThroughAllHeights) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  const Map map([&](double, double) { return normal(random); });
  for (std::size_t j = 0; j < map.rows; ++j)
    for (std::size_t i = 0; i < map.columns; ++i) {
      const core::ReliefSample at =
          core::relief_at(map.level(), q32(static_cast<double>(i)), q32(static_cast<double>(j)));
      EXPECT_NEAR(at.value, map.heights[j * map.columns + i], 2e-6);
    }
}

double rms_slope_error(double samples_per_period) {
  const double k = kTurnRad / samples_per_period;
  const Map map([&](double x, double) { return std::sin(k * x); });
  double error = 0, whole = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 12 + 24.0 * i / 1000;
    const double slope = core::relief_at(map.level(), q32(x), q32(20)).by_x;
    error += std::pow(slope - k * std::cos(k * x), 2);
    whole += std::pow(k * std::cos(k * x), 2);
  }
  return std::sqrt(error / whole);
}

// The bars of the issue on force scenes; a prototype had 0.33 and 0.036 %.
TEST(SceneRelief, TheGradientOfASineIsItsDerivative) {
  const double at_8 = rms_slope_error(8), at_16 = rms_slope_error(16);
  std::printf("  gradient of a sine relief: %.3f %% at 8 samples a period, %.4f %% at 16\n", 100 * at_8,
              100 * at_16);
  EXPECT_LT(at_8, 0.004);
  EXPECT_LT(at_16, 0.0004);
}

// Work along a closed path over white noise, relative to the sum of its absolute parts (a trapezoid rule of
// 1e5 steps).
TEST(SceneRelief, NoWorkAlongAClosedPath) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const Map map([&](double, double) { return normal(random); });
  const int steps = 100'000;
  double work = 0, absolute = 0;
  for (int i = 0; i < steps; ++i) {
    const double angle = kTurnRad * (i + 0.5) / steps;
    const double x = 24 + 10 * std::cos(angle), y = 20 + 10 * std::sin(angle);
    const core::ReliefSample at = core::relief_at(map.level(), q32(x), q32(y));
    const double part = (at.by_x * -std::sin(angle) + at.by_y * std::cos(angle)) * 10 * kTurnRad / steps;
    work += part;
    absolute += std::abs(part);
  }
  std::printf("  work along a closed path: %.2g of its absolute sum\n", std::abs(work) / absolute);
  EXPECT_LT(std::abs(work), 1e-6 * absolute);
}

TEST(SceneRelief, BeyondTheEdgeTheSurfaceIsLevelAcrossIt) {
  const Map map([](double x, double y) { return 0.1 * x * x + y; });
  const core::ReliefSample far = core::relief_at(map.level(), q32(-1000), q32(20));
  EXPECT_EQ(far.by_x, 0);
  const core::ReliefSample inside = core::relief_at(map.level(), q32(10), q32(20));
  EXPECT_NEAR(inside.by_x, 2, 1e-4);
  EXPECT_NEAR(inside.by_y, 1, 1e-5);
}

// White noise has frequencies up to the corner of the spectrum; half octaves go down from there to the lowest
// cosine. What is above a level's highest frequency is gone, what is below 0.8 of it is whole.
TEST(SceneRelief, LevelsPassHalfAnOctaveLessEach) {
  schema::HeightMap map;
  map.columns = 96, map.rows = 80, map.pitch_m = 1e-4;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < map.columns * map.rows; ++i)
    map.height_m.push_back(static_cast<float>(1e-5 * normal(random)));
  const auto relief = relief_levels(map, 4000, 10, "map");
  ASSERT_TRUE(relief);
  EXPECT_NEAR(relief->highest_per_m, std::numbers::sqrt2 / 2 / map.pitch_m, 0.02 / map.pitch_m);
  ASSERT_GT(relief->levels.size(), 10U);
  for (const std::size_t n : {1U, 4U, 9U}) {
    const ReliefLevel& level = relief->levels[n];
    const double highest = relief->highest_per_m * map.pitch_m * std::exp2(-0.5 * static_cast<double>(n));
    EXPECT_EQ(level.columns, std::ceil(96 * 12 * highest)) << n;
    // Heights of the level at its own samples, and their cosines beside those of the map.
    std::vector<double> heights(level.columns * level.rows), whole(map.height_m.begin(), map.height_m.end());
    const core::ReliefLevel in_core{level.coefficients.data(), static_cast<std::uint32_t>(level.columns),
                                    static_cast<std::uint32_t>(level.rows)};
    for (std::size_t i = 0; i < heights.size(); ++i)
      heights[i] = double{core::relief_at(in_core, q32(static_cast<double>(i % level.columns)),
                                          q32(static_cast<double>(i / level.columns)))
                              .value};
    spatial::to_cosines(heights, {level.columns, level.rows});
    spatial::to_cosines(whole, {map.columns, map.rows});
    const double scale = static_cast<double>(whole.size()) / static_cast<double>(heights.size());
    double stopped = 0, changed = 0, all = 0;
    for (std::size_t l = 0; l < level.rows; ++l)
      for (std::size_t k = 0; k < level.columns; ++k) {
        if (k + l == 0) continue;
        const bool in_map = k < map.columns && l < map.rows;
        const double of_level = scale * heights[l * level.columns + k],
                     of_map = in_map ? whole[l * map.columns + k] : 0;
        const double part = std::hypot(static_cast<double>(k) / 192, static_cast<double>(l) / 160) / highest;
        all = std::max(all, std::abs(of_map));
        if (part > 1) stopped = std::max(stopped, std::abs(of_level));
        if (part < 0.8) changed = std::max(changed, std::abs(of_level - of_map));
      }
    EXPECT_LT(stopped, 1e-5 * all) << n;  // the rounding of 7680 heights to single precision
    EXPECT_LT(changed, 1e-5 * all) << n;
  }
}

// A sine of period 16 samples, its curvature k^2 A; a saddle's eigenvalues are +-2 where its axes are
// diagonal.
TEST(SceneRelief, TheLargestCurvatureIsTheEigenvalueOfTheHessian) {
  schema::HeightMap map;
  map.columns = 64, map.rows = 48, map.pitch_m = 1e-3;
  const auto largest = [&](const std::function<double(double, double)>& height) {
    map.height_m.clear();
    for (std::size_t j = 0; j < map.rows; ++j)
      for (std::size_t i = 0; i < map.columns; ++i)
        map.height_m.push_back(static_cast<float>(height(static_cast<double>(i), static_cast<double>(j))));
    return relief_levels(map, 1000, 10, "map")->curvature_per_m(0.04, 0.03) * 1e-6;  // per squared sample
  };
  const double k = kTurnRad / 16;
  // At a crest the curvature of the spline is 1 + k^2 / 12 times that of the sine: 1.3 %.
  EXPECT_NEAR(largest([&](double x, double) { return 1e-3 * std::cos(k * (x - 24)); }), 1e-3 * k * k,
              2e-2 * 1e-3 * k * k);
  EXPECT_NEAR(
      largest([&](double x, double y) { return 1e-3 * std::cos(k * (x - 24)) * std::sin(k * (y + 0.5)); }),
      1e-3 * k * k, 3e-2 * 1e-3 * k * k);
}

}  // namespace
}  // namespace tacto::playback

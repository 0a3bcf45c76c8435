// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/average_textures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tacto::spatial {
namespace {

constexpr double kAveragePitch_m = 1e-6, kNoise_n = 0.1;

double averaged_surface(double position_m) {
  return std::sin(2e3 * position_m) + 0.5 * std::sin(7e3 * position_m + 1);
}

// `count` samples of the surface from `first` pitches on, with noise.
schema::Texture stroke_over(int first, std::size_t count, unsigned seed, double noise_n = kNoise_n) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, noise_n);
  schema::Texture texture;
  texture.signal.pitch_m = kAveragePitch_m;
  texture.source_origin_m = first * kAveragePitch_m;
  for (std::size_t i = 0; i < count; ++i)
    texture.signal.values.push_back(averaged_surface((first + static_cast<double>(i)) * kAveragePitch_m) +
                                    normal(random));
  texture.valid_band = {{0, 300, 10000}, {static_cast<double>(count - 1) * kAveragePitch_m, 300, 10000}};
  texture.source.mean_speed_mps = 0.05;
  return texture;
}

schema::AveragedStroke numbered(int stroke) {
  schema::AveragedStroke made;
  made.stroke = stroke;
  return made;
}

TEST(AverageTextures, NoiseFallsWithTheRootOfTheirNumberAndIsTheSpread) {
  constexpr int kStrokes = 25;
  TextureAverager averager;
  for (int n = 0; n < kStrokes; ++n)
    ASSERT_TRUE(averager.add(stroke_over(-500, 20000, 10U + static_cast<unsigned>(n)), numbered(n + 1)));
  const auto mean = averager.finish("position");
  ASSERT_TRUE(mean) << schema::message(mean.error());
  ASSERT_EQ(mean->signal.values.size(), 20000U);
  ASSERT_EQ(mean->average->spread.size(), 20000U);
  double error = 0, variance = 0;
  for (std::size_t i = 0; i < 20000; ++i) {
    error += std::pow(
        mean->signal.values[i] - averaged_surface(mean->source_origin_m + mean->signal.position_m(i)), 2);
    variance += std::pow(mean->average->spread[i], 2);
  }
  // Of 20,000 independent samples: 5 standard deviations are 2.5 % of a standard deviation.
  EXPECT_NEAR(std::sqrt(error / 20000), kNoise_n / 5, 0.025 * kNoise_n / 5);
  EXPECT_NEAR(std::sqrt(variance / 20000), kNoise_n, 0.025 * kNoise_n);
  EXPECT_EQ(mean->average->strokes.size(), 25U);
  ASSERT_EQ(mean->average->counts.size(), 1U);
  EXPECT_EQ(mean->average->counts[0].strokes, kStrokes);
  EXPECT_NEAR(mean->source_origin_m, -500e-6, 1e-12);
}

TEST(AverageTextures, CountsStrokesWhereTheyDiffer) {
  TextureAverager averager;
  // 0 ... 9999, 1000 ... 10999, 2000 ... 11999: at least two overlap over 1000 ... 10999.
  for (int n = 0; n < 3; ++n)
    ASSERT_TRUE(averager.add(stroke_over(1000 * n, 10000, static_cast<unsigned>(n), 0), numbered(n + 1)));
  const auto mean = averager.finish("position");
  ASSERT_TRUE(mean);
  ASSERT_EQ(mean->signal.values.size(), 10000U);
  EXPECT_NEAR(mean->source_origin_m, 1e-3, 1e-12);
  const auto& counts = mean->average->counts;
  ASSERT_EQ(counts.size(), 3U);
  EXPECT_EQ(counts[0].strokes, 2);
  EXPECT_EQ(counts[1].strokes, 3);
  EXPECT_NEAR(counts[1].position_m, 1e-3, 1e-12);
  EXPECT_EQ(counts[2].strokes, 2);
  for (std::size_t i = 0; i < 10000; ++i)
    ASSERT_NEAR(mean->signal.values[i], averaged_surface(1e-3 + static_cast<double>(i) * kAveragePitch_m),
                1e-12);
}

TEST(AverageTextures, TheBandIsWhatAllKnow) {
  TextureAverager averager;
  auto slow = stroke_over(0, 5000, 1), fast = stroke_over(0, 5000, 2);
  slow.valid_band = {{0, 750, 25000}, {4999e-6, 750, 25000}};
  fast.valid_band = {{0, 150, 5000}, {4999e-6, 150, 5000}};
  ASSERT_TRUE(averager.add(slow, numbered(1)));
  ASSERT_TRUE(averager.add(fast, numbered(2)));
  const auto mean = averager.finish("position");
  ASSERT_TRUE(mean);
  for (const auto& point : mean->valid_band) {
    EXPECT_EQ(point.low_per_m, 750);
    EXPECT_EQ(point.high_per_m, 5000);
  }
  EXPECT_EQ(mean->valid_band.front().position_m, 0);
  EXPECT_NEAR(mean->valid_band.back().position_m, 4999e-6, 1e-12);
}

TEST(AverageTextures, RefusesWhatHasNoMean) {
  TextureAverager averager;
  EXPECT_FALSE(averager.finish("position"));
  ASSERT_TRUE(averager.add(stroke_over(0, 1000, 1), numbered(1)));
  EXPECT_EQ(averager.finish("position").error().kind, schema::ErrorKind::unsuitable);
  const auto away = averager.add(stroke_over(100000, 1000, 1), numbered(2));
  ASSERT_FALSE(away);
  EXPECT_NE(schema::message(away.error()).find("from the others"), std::string::npos);
  auto coarse = stroke_over(0, 1000, 1);
  coarse.signal.pitch_m = 2e-6;
  EXPECT_FALSE(averager.add(coarse, numbered(2)));
  ASSERT_TRUE(averager.add(stroke_over(3000, 1000, 1), numbered(2)));
  EXPECT_EQ(averager.finish("position").error().kind, schema::ErrorKind::unsuitable);
}

}  // namespace
}  // namespace tacto::spatial

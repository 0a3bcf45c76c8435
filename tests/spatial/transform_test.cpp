// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/transform/transform.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "spatial/dsp/resample/windowed_sinc.hpp"
#include "spatial/transform/period.hpp"
#include "spatial/transform/stretch.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Lengthening;
using schema::Texture;
using schema::TransformOperation;

constexpr double kWholeTurn = 2 * std::numbers::pi;
// Experiment 2 of Wiertlewski 2011.
constexpr double kPeriod_m = 1.76e-3, kAmplitude_m = 12.8e-6, kPhase = 0.4;
constexpr double kFactors[] = {1.3, 0.7, 1.7, 0.3};

Texture height_texture(std::vector<double> values, double pitch_m = 1e-6) {
  Texture texture;
  texture.signal = {pitch_m, 0, std::move(values)};
  texture.quantity = "height";
  texture.unit = "m";
  return texture;
}

double wave_at(double position_m, double period_m, double amplitude) {
  return amplitude * std::sin(kWholeTurn * position_m / period_m + kPhase);
}

Texture sinusoid(std::size_t samples, double period_m = kPeriod_m, double pitch_m = 1e-6) {
  std::vector<double> values(samples);
  for (std::size_t i = 0; i < samples; ++i)
    values[i] = wave_at(static_cast<double>(i) * pitch_m, period_m, kAmplitude_m);
  return height_texture(std::move(values), pitch_m);
}

// The largest difference from the closed form from sample `first` on, re the amplitude.
double miss_of(const Texture& texture, double period_m, double amplitude, std::size_t first = 0) {
  double error = 0;
  const auto& signal = texture.signal;
  for (std::size_t i = first; i < signal.values.size(); ++i)
    error = std::max(error, std::abs(signal.values[i] - wave_at(signal.position_m(i), period_m, amplitude)));
  return error / amplitude;
}

double steepest(const Texture& texture) {
  double slope = 0;
  const auto& values = texture.signal.values;
  for (std::size_t i = 1; i < values.size(); ++i)
    slope = std::max(slope, std::abs(values[i] - values[i - 1]) / texture.signal.pitch_m);
  return slope;
}

// Lines at frequencies in no simple ratio, up to 0.02 of the samples per metre: it fits itself nowhere.
Texture irregular(std::size_t samples) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> phase(0, kWholeTurn);
  std::vector<double> values(samples, 0.0);
  for (int line = 1; line <= 25; ++line) {
    const double cycles = 0.0008 * line * (1 + 0.017 * std::sqrt(line)), start = phase(random);
    for (std::size_t i = 0; i < samples; ++i)
      values[i] += 1e-6 * std::sin(kWholeTurn * cycles * static_cast<double>(i) + start);
  }
  return height_texture(std::move(values));
}

ErrorKind kind_of(const schema::Result<Texture>& result) {
  EXPECT_FALSE(result);
  return result ? ErrorKind::internal : result.error().kind;
}

TEST(Stretch, ASinusoidOfWholePeriodsHasTheClosedForm) {
  const Texture source = sinusoid(17600);  // ten periods
  for (const double factor : kFactors)
    for (const bool keep_slope : {false, true}) {
      const auto result = stretch(source, {factor, keep_slope, std::nullopt, std::nullopt});
      ASSERT_TRUE(result) << message(result.error());
      const double amplitude = kAmplitude_m * (keep_slope ? factor : 1), period_m = kPeriod_m * factor;
      // Four times the largest of these; windowed_sinc_test allows 2e-6 of tones that are twenty times as
      // high.
      EXPECT_LT(miss_of(*result, period_m, amplitude), 1e-7) << factor;
      EXPECT_NEAR(steepest(*result) * period_m / (kWholeTurn * amplitude), 1, 1e-4) << factor;
      // Whole periods, as near to the old length as they can be.
      const double periods = static_cast<double>(result->signal.values.size()) * 1e-6 / period_m;
      EXPECT_EQ(std::round(periods), std::round(17.6e-3 / period_m)) << factor;
      EXPECT_NEAR(periods, std::round(periods), 0.5e-6 / period_m + 1e-9) << factor;
      const auto& step = result->transform->steps.back();
      EXPECT_EQ(step.lengthening, Lengthening::periods);
      EXPECT_NEAR(*step.period_m, kPeriod_m, 1e-12);
      EXPECT_EQ(*step.joints, static_cast<int>(std::ceil(periods / 10 - 1e-3)) - 1) << factor;
      EXPECT_EQ(step.joint_error.has_value(), factor < 1);
      if (step.joint_error) {
        EXPECT_LT(*step.joint_error, 1e-5);
      }
      EXPECT_FALSE(step.removed_share);
    }
}

TEST(Stretch, ASinusoidOfAnyLengthIsJoinedAtItsPeriods) {
  const Texture source = sinusoid(16123);
  for (const double factor : kFactors) {
    const auto result = stretch(source, {factor, true, std::nullopt, std::nullopt});
    ASSERT_TRUE(result) << message(result.error());
    EXPECT_NEAR(*result->transform->steps.back().period_m, kPeriod_m, 1e-6 * kPeriod_m);
    // Of at most four joints, each 8 periods apart: 1e-6 of a period each.
    const double tolerance = 4 * 8 * kWholeTurn * 1e-6;
    // The interpolation reaches over the beginning of the record, up to its sample 16.
    const auto first = static_cast<std::size_t>(std::ceil(16 * factor));
    EXPECT_LT(miss_of(*result, kPeriod_m * factor, kAmplitude_m * factor, first), tolerance) << factor;
    EXPECT_LT(miss_of(*result, kPeriod_m * factor, kAmplitude_m * factor), 1e-3) << factor;
  }
}

TEST(Stretch, APeriodOfFewSamplesIsInterpolatedAsWell) {
  const Texture source = sinusoid(20000, 4.1e-6);  // 0.24 of the samples per metre
  const auto result = stretch(source, {0.7, false, Lengthening::periods, 4.1e-6});
  ASSERT_TRUE(result) << message(result.error());
  EXPECT_LT(miss_of(*result, 0.7 * 4.1e-6, kAmplitude_m, 32), 1e-4);
}

TEST(Stretch, WhatHasNoPeriodKeepsItsLengthAndIsJoinedWhereItFits) {
  const Texture source = irregular(30000);
  for (const double factor : {0.7, 0.3, 1.6}) {
    const auto result = stretch(source, {factor, false, std::nullopt, std::nullopt});
    ASSERT_TRUE(result) << message(result.error());
    const auto& step = result->transform->steps.back();
    EXPECT_EQ(step.lengthening, Lengthening::best_fit);
    EXPECT_EQ(result->signal.values.size(), source.signal.values.size());
    if (factor > 1) {
      EXPECT_EQ(*step.joints, 0);
      EXPECT_NEAR(*step.left_out_m, 29999e-6 * (1 - 1 / factor), 1e-9);
      continue;
    }
    EXPECT_GE(*step.joints, static_cast<int>(1 / factor));
    // Of 4e6 pairs in a plane of value and slope the nearest is near.
    EXPECT_LT(*step.joint_error, 0.01);
    // No step exceeds the steepest of the source by more than the joint's error.
    EXPECT_LT(steepest(*result), 1.02 * steepest(source) / factor);
  }
}

// A sinusoid fits everywhere: the joint is as late as the interpolation allows.
TEST(Stretch, OfEqualJointsTheOneThatLeavesOutTheLeastIsTaken) {
  for (const std::size_t samples : {17600U, 17603U}) {
    const auto result = stretch(sinusoid(samples), {0.7, false, Lengthening::best_fit, std::nullopt});
    ASSERT_TRUE(result) << message(result.error());
    const auto& step = result->transform->steps.back();
    EXPECT_NEAR(*step.left_out_m, 1e-6 * static_cast<double>(WindowedSinc::kReach), 1e-9) << samples;
    EXPECT_LT(*step.joint_error, 1.1e-3)
        << samples;  // the least one is below 1e-4, and joints within 1e-3 are equal
  }
}

TEST(Stretch, TheValidBandMovesWithTheTexture) {
  Texture source = sinusoid(17600);
  source.valid_band = {{0, 200, 8000}, {0.01, 300, 10000}, {0.0176, 400, 9000}};
  const auto longer = stretch(source, {1.5, false, Lengthening::periods, kPeriod_m});
  ASSERT_TRUE(longer) << message(longer.error());
  ASSERT_EQ(longer->valid_band.size(), 3u);
  EXPECT_NEAR(longer->valid_band[1].position_m, 0.015, 1e-9);
  EXPECT_NEAR(longer->valid_band[1].low_per_m, 200, 1e-9);
  EXPECT_NEAR(longer->valid_band[1].high_per_m, 10000 / 1.5, 1e-6);
  EXPECT_NEAR(longer->valid_band[2].position_m, longer->signal.length_m(), 1e-9);
  const auto shorter = stretch(source, {0.6, false, Lengthening::periods, kPeriod_m});
  ASSERT_TRUE(shorter) << message(shorter.error());
  // Two passes: 0, 6 and 10.56 mm, then 10.56, 16.56 and the end.
  ASSERT_EQ(shorter->valid_band.size(), 6u);
  EXPECT_NEAR(shorter->valid_band[3].position_m, 0.01056, 1e-9);
  EXPECT_NEAR(shorter->valid_band[3].high_per_m, 8000 / 0.6, 1e-6);
  EXPECT_NEAR(shorter->valid_band[4].position_m, 0.01656, 1e-9);
  EXPECT_NEAR(shorter->valid_band[4].high_per_m, 10000 / 0.6, 1e-6);
}

TEST(Stretch, RemovesAndNamesWhatTheGridCannotHold) {
  Texture source = sinusoid(20000, 200e-6);
  const Texture fine = sinusoid(20000, 4e-6);
  for (std::size_t i = 0; i < 20000; ++i) source.signal.values[i] += 0.5 * fine.signal.values[i];
  source.valid_band = {{0, 0, 300000}};
  const auto result = stretch(source, {0.4, false, Lengthening::periods, 200e-6});
  ASSERT_TRUE(result) << message(result.error());
  const auto& step = result->transform->steps.back();
  EXPECT_NEAR(*step.removed_above_per_m, 450000, 1e-3);
  EXPECT_NEAR(*step.removed_share, 0.5 / std::sqrt(1.25), 1e-3);
  EXPECT_NEAR(result->valid_band.front().high_per_m, 450000, 1e-3);
  EXPECT_LT(miss_of(*result, 80e-6, kAmplitude_m), 1e-4);
  // With a larger factor nothing is lost.
  const auto held = stretch(source, {0.8, false, Lengthening::periods, 200e-6});
  ASSERT_TRUE(held);
  EXPECT_FALSE(held->transform->steps.back().removed_share);
  EXPECT_EQ(kind_of(stretch(fine, {0.4, false, Lengthening::periods, 4e-6})), ErrorKind::unsuitable);
}

TEST(Stretch, RefusesWhatItCannotStretch) {
  const Texture source = sinusoid(17600);
  for (const double factor : {0.0, -1.0, 0.01, 100.0, std::nan("")})
    EXPECT_EQ(kind_of(stretch(source, {factor, false, std::nullopt, std::nullopt})), ErrorKind::usage);
  EXPECT_EQ(kind_of(stretch(source, {1.3, false, std::nullopt, 0})), ErrorKind::usage);
  EXPECT_EQ(kind_of(stretch(source, {1.3, false, std::nullopt, 0.02})), ErrorKind::unsuitable);
  EXPECT_EQ(kind_of(stretch(sinusoid(100), {1.3, false, std::nullopt, std::nullopt})), ErrorKind::unsuitable);
  EXPECT_EQ(kind_of(stretch(irregular(30000), {0.7, false, Lengthening::periods, std::nullopt})),
            ErrorKind::unsuitable);
  const Texture level = height_texture(std::vector<double>(1000, 0.3));
  EXPECT_EQ(kind_of(stretch(level, {0.7, false, std::nullopt, std::nullopt})), ErrorKind::unsuitable);
}

TEST(Period, IsFoundUnderNoiseAndOnlyWhereThereIsOne) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1);
  for (const double samples : {37.3, 1760.0, 2311.7}) {
    std::vector<double> values(25000);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double turn = kWholeTurn * static_cast<double>(i) / samples;
      values[i] = std::sin(turn) + 0.8 * std::sin(3 * turn + 1) + 5;  // the third alone is not the period
    }
    const auto exact = find_period(values);
    ASSERT_TRUE(exact) << samples;
    EXPECT_NEAR(*exact / samples, 1, 3e-6);
    for (double& value : values) value += 0.1 * normal(random);
    const auto noisy = find_period(values);
    ASSERT_TRUE(noisy) << samples;
    // Four times the largest of 20 seeds for each.
    EXPECT_NEAR(*noisy / samples, 1, 1e-4);
  }
  EXPECT_FALSE(find_period(irregular(30000).signal.values));
  std::vector<double> noise(20000);
  for (double& value : noise) value = normal(random);
  EXPECT_FALSE(find_period(noise));
  EXPECT_FALSE(find_period(std::vector<double>(1000, 2.0)));
}

TEST(Transform, GainAndFilterAddTheirSteps) {
  Texture source = sinusoid(20000, 100e-6);
  const Texture slow = sinusoid(20000, 1e-3);
  for (std::size_t i = 0; i < 20000; ++i) source.signal.values[i] += slow.signal.values[i];
  source.valid_band = {{0, 100, 20000}, {0.019999, 100, 5000}};
  source.source.recording = "oak.json";
  source.average = schema::TextureAverage{};
  source.surface = "oak";
  const auto louder = with_gain(source, -2);
  ASSERT_TRUE(louder);
  EXPECT_EQ(louder->signal.values[777], -2 * source.signal.values[777]);
  const auto band = filtered(*louder, 4000, 30000);
  ASSERT_TRUE(band) << message(band.error());
  // The ends are treated (fourier_filter.hpp): the middle half has the tone to 0.2 %.
  for (std::size_t i = 5000; i < 15000; ++i)
    ASSERT_NEAR(band->signal.values[i], -2 * wave_at(static_cast<double>(i) * 1e-6, 100e-6, kAmplitude_m),
                0.004 * kAmplitude_m);
  EXPECT_EQ(band->valid_band[0].low_per_m, 4000);
  EXPECT_EQ(band->valid_band[0].high_per_m, 20000);
  EXPECT_EQ(band->surface, "oak");
  EXPECT_TRUE(band->source.recording.empty());
  EXPECT_FALSE(band->average);
  ASSERT_EQ(band->transform->steps.size(), 2u);
  EXPECT_EQ(band->transform->steps[0].operation, TransformOperation::gain);
  EXPECT_EQ(*band->transform->steps[0].factor, -2);
  EXPECT_EQ(*band->transform->steps[1].high_per_m, 30000);
  for (const double gain : {0.0, std::nan(""), HUGE_VAL})
    EXPECT_EQ(kind_of(with_gain(source, gain)), ErrorKind::usage);
  EXPECT_EQ(kind_of(filtered(source, 4000, 600000)), ErrorKind::unsuitable);
  EXPECT_EQ(kind_of(filtered(source, 4000, 3000)), ErrorKind::unsuitable);
}

TEST(Transform, AMixIsTheWeightedSumOnTheFinestGrid) {
  Texture fine = sinusoid(20000, 700e-6);
  Texture coarse = sinusoid(6000, 300e-6, 2.5e-6);  // 15 mm long
  fine.valid_band = {{0, 100, 90000}, {0.01, 200, 80000}};
  coarse.valid_band = {{0, 150, 200000}};
  fine.surface = "oak";
  coarse.surface = "pine";
  const std::vector<Texture> both = {fine, coarse};
  const std::vector<double> weights = {0.5, -2};
  const auto mixed = mix(both, weights);
  ASSERT_TRUE(mixed) << message(mixed.error());
  EXPECT_EQ(mixed->signal.pitch_m, 1e-6);
  ASSERT_EQ(mixed->signal.values.size(), 14998u);  // to 5999 * 2.5 um = 14.9975 mm
  EXPECT_NEAR(*mixed->transform->steps.back().left_out_m, 19.999e-3 - 14.9975e-3, 1e-9);
  for (std::size_t i = 40; i + 40 < mixed->signal.values.size(); ++i) {
    const double place_m = static_cast<double>(i) * 1e-6;
    ASSERT_NEAR(mixed->signal.values[i],
                0.5 * wave_at(place_m, 700e-6, kAmplitude_m) - 2 * wave_at(place_m, 300e-6, kAmplitude_m),
                1e-5 * kAmplitude_m)
        << i;
  }
  // All have it: from the higher of the lower ends to the lower of the upper ones.
  ASSERT_EQ(mixed->valid_band.size(), 3u);
  EXPECT_EQ(mixed->valid_band[0].low_per_m, 150);
  EXPECT_EQ(mixed->valid_band[1].low_per_m, 200);
  EXPECT_EQ(mixed->valid_band[1].high_per_m, 80000);
  EXPECT_EQ(mixed->surface, "oak; pine");

  coarse.quantity = "displacement";
  EXPECT_EQ(kind_of(mix(std::vector{fine, coarse}, weights)), ErrorKind::unsuitable);
  EXPECT_EQ(kind_of(mix(std::vector{fine}, std::vector<double>{1})), ErrorKind::usage);
  EXPECT_EQ(kind_of(mix(both, std::vector<double>{1, 0})), ErrorKind::usage);
  fine.simulated = "the emulated device";
  coarse.quantity = "height";
  EXPECT_EQ(kind_of(mix(std::vector{fine, coarse}, weights)), ErrorKind::unsuitable);
}

}  // namespace
}  // namespace tacto::spatial

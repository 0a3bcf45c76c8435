// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/render.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <span>

#include "made_textures.hpp"
#include "playback/render/reference/exact_target.hpp"

namespace tacto::playback {
namespace {

schema::Transducer paper() {
  return *schema::read_transducer("wiertlewski2011");
}

// Amplitude and phase (re sine) of one frequency over the middle of a signal: a whole number of periods
// between from_s and to_s.
std::complex<double> tone(const schema::TimeSignal& signal, double frequency_hz, double from_s, double to_s) {
  const auto first = static_cast<std::size_t>(std::llround(from_s * signal.sample_rate_hz));
  const auto last = static_cast<std::size_t>(std::llround(to_s * signal.sample_rate_hz));
  std::complex<double> sum = 0;
  for (std::size_t i = first; i < last; ++i)
    sum += signal.values[i] * std::polar(1.0, -kTwoPi * frequency_hz * signal.time_s(i));
  return sum * std::complex<double>(0, 2) / static_cast<double>(last - first);
}

double rms_between(const schema::TimeSignal& signal, double from_s, double to_s) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < signal.values.size(); ++i) {
    if (signal.time_s(i) < from_s || signal.time_s(i) > to_s) continue;
    sum += signal.values[i] * signal.values[i];
    ++count;
  }
  return std::sqrt(sum / static_cast<double>(count));
}

// 5 /mm under 50 mm/s is 250 Hz: 10 mN at 1 mm/N is 10 um, and needs a drive of 10 um / H_a(250 Hz). 1e-4:
// the effect of the path's ends in the middle, with a band cut by Fourier truncation.
TEST(Render, ASineAtOneSpeedHasItsClosedForm) {
  const auto texture = sine_texture(0.12, 5e3, 0.01);
  const auto rendering = render(texture, steady_path(0.005, 0.05, 2), paper(), {});
  ASSERT_TRUE(rendering) << message(rendering.error());
  // sin(2 pi 5e3 (0.005 + 0.05 t)) starts with phase zero: 25 whole periods.
  const std::complex<double> target = 10e-6;
  EXPECT_LT(std::abs(tone(rendering->target_m, 250, 0.6, 1.4) - target), 1e-4 * 10e-6);
  EXPECT_LT(std::abs(tone(rendering->modelled_m, 250, 0.6, 1.4) - target), 1e-4 * 10e-6);
  const auto drive = target / schema::actuator_response(paper(), 250);
  EXPECT_LT(std::abs(tone(rendering->drive_v, 250, 0.6, 1.4) - drive), 1e-4 * std::abs(drive));
  EXPECT_EQ(rendering->delay_s, 0);
  EXPECT_NEAR(rendering->max_speed_mps, 0.05, 1e-12);
  EXPECT_NEAR(rendering->highest_passed_per_m, 10e3, 1e-6);
}

// The tick kernel instead of the reference: the target, with an encoder of 1 um, within -40 dB (including the
// onset), and the same drive to -40 dB away from the path's ends.
TEST(Render, TheKernelsDriveIsTheReferences) {
  const auto texture = texture_of(0.12, [](double x) {
    return 0.01 * (std::sin(kTwoPi * 1e3 * x) + 0.5 * std::sin(kTwoPi * 4.3e3 * x));
  });
  const auto path = steady_path(0.005, 0.0517, 2);
  RenderOptions options;
  options.hold = Hold::zero_order;
  options.onset_s = kReferenceOnsetS;
  const auto exact = render(texture, path, paper(), options);
  options.engine = Engine::kernel;
  const auto kernel = render(texture, path, paper(), options);
  ASSERT_TRUE(exact && kernel) << message(kernel.error());
  EXPECT_LT(kernel->error_db, -30);
  EXPECT_EQ(kernel->delay_s, 0);
  EXPECT_FALSE(kernel->clipping);
  auto difference = exact->modelled_m;
  for (std::size_t i = 0; i < difference.values.size(); ++i)
    difference.values[i] -= kernel->modelled_m.values[i];
  EXPECT_LT(rms_between(difference, 0.2, 1.8), 1e-2 * rms_between(exact->modelled_m, 0.2, 1.8));
}

TEST(Render, WhatTheKernelsLimitsTookAwayIsRefusedOrTold) {
  const auto texture = sine_texture(0.12, 5e3, 0.2);
  RenderOptions options;
  options.engine = Engine::kernel;
  const auto refused = render(texture, steady_path(0.005, 0.05, 2), paper(), options);
  ASSERT_FALSE(refused);
  EXPECT_NE(message(refused.error()).find("--over-limit"), std::string::npos);
  options.over_limit = OverLimit::clip;
  const auto clipped = render(texture, steady_path(0.005, 0.05, 2), paper(), options);
  ASSERT_TRUE(clipped);
  ASSERT_TRUE(clipped->clipping);
  EXPECT_GT(clipped->clipping->samples, 5000U);
  EXPECT_GT(clipped->clipping->removed_db, -20);
  EXPECT_LE(clipped->peaks.drive_v.value, 5);
}

TEST(Render, SignalsShareThePathsAxis) {
  const auto texture = sine_texture(0.12, 5e3, 0.01);
  FingerPath path = steady_path(0.005, 0.05, 2);
  for (double& t : path.time_s) t += 3;
  const auto rendering = render(texture, path, paper(), {});
  ASSERT_TRUE(rendering);
  for (const auto* signal : {&rendering->drive_v, &rendering->target_m, &rendering->modelled_m}) {
    EXPECT_EQ(signal->values.size(), 20001U);
    EXPECT_EQ(signal->start_s, 3);
    EXPECT_EQ(signal->sample_rate_hz, 10e3);
  }
  for (double value : rendering->drive_v.values) ASSERT_EQ(value, static_cast<float>(value));
}

// The displacement for the rounded, cut drive, against the target. -60 dB: a tenth of the required 1 %.
TEST(Render, ModelledDisplacementFollowsTheTarget) {
  const auto texture = texture_of(0.06, [](double x) {
    return 0.01 * (std::sin(kTwoPi * 1e3 * x) + 0.5 * std::sin(kTwoPi * 2.3e3 * x) +
                   0.3 * std::sin(kTwoPi * 6.1e3 * x));
  });
  RenderOptions options;
  for (const auto filter : {Reconstruction::none, Reconstruction::butterworth3})
    for (const auto hold : {Hold::none, Hold::zero_order}) {
      options.reconstruction = filter;
      options.hold = hold;
      const auto rendering = render(texture, there_and_back(-0.01, 0.08, 3), paper(), options);
      ASSERT_TRUE(rendering) << message(rendering.error());
      EXPECT_LT(rendering->error_db, -60);
    }
  options.inverse = Inverse::gain;
  EXPECT_GT(render(texture, there_and_back(-0.01, 0.08, 3), paper(), options)->error_db, -20);
}

// Back and forth along the same path is its own mirror image in time, and so is the target, including the
// ends.
TEST(Render, AReversalMirrorsTheDisplacement) {
  const auto texture = sine_texture(0.06, 3e3, 0.01);
  const auto rendering = render(texture, there_and_back(0.01, 0.04, 2), paper(), {});
  ASSERT_TRUE(rendering);
  const auto& target = rendering->target_m.values;
  for (std::size_t i = 0; i < target.size(); ++i)
    ASSERT_NEAR(target[i], target[target.size() - 1 - i], 1e-4 * 10e-6);
}

// 20 /mm under 100 mm/s is 2 kHz, above the band; 97 /mm is 9.7 kHz, which would alias to 300 Hz if the
// texture were read once per sample. The result is at least 60 dB below the texture, away from the path's
// ends.
TEST(Render, NothingFoldsIntoTheBand) {
  for (const double per_m : {20e3, 97e3, 103e3}) {
    const auto texture = sine_texture(0.12, per_m, 0.01);
    const auto rendering = render(texture, steady_path(0.005, 0.1, 1), paper(), {});
    ASSERT_TRUE(rendering) << message(rendering.error());
    EXPECT_GT(rendering->reading_rate_hz, 2 * per_m * 0.1);
    EXPECT_LT(rms_between(rendering->target_m, 0.2, 0.8), 1e-3 * 10e-6 / std::sqrt(2)) << per_m;
    EXPECT_LT(rms_between(rendering->modelled_m, 0.2, 0.8), 1e-3 * 10e-6 / std::sqrt(2)) << per_m;
  }
}

TEST(Render, BesideTheTextureThereIsSilenceAndNoClickAtItsEnds) {
  const auto texture = texture_of(0.02, [](double x) { return 0.02 * std::cos(kTwoPi * 2e3 * x); });
  RenderOptions options;
  options.at_m = 0.03;
  const auto rendering = render(texture, steady_path(0, 0.04, 2), paper(), options);
  ASSERT_TRUE(rendering) << message(rendering.error());
  // 0.03 m is reached at 0.75 s and 0.05 m passed at 1.25 s; both instants are samples, and inside.
  EXPECT_NEAR(static_cast<double>(rendering->samples_outside), 20001 - 5001, 2);
  const double inside = rms_between(rendering->target_m, 0.8, 1.2);
  EXPECT_LT(rms_between(rendering->target_m, 0, 0.5), 0.01 * inside);
  // 80 Hz of 20 um changes by at most 2 pi 80 20e-6 / rate from sample to sample; the fade adds pi / (2 x 25
  // ms).
  const double steepest = 20e-6 * (kTwoPi * 80 + std::numbers::pi / 0.05) / 10e3;
  const auto& target = rendering->target_m.values;
  for (std::size_t i = 1; i < target.size(); ++i)
    ASSERT_LT(std::abs(target[i] - target[i - 1]), 1.1 * steepest);
}

// Without the onset the drive would begin with a jump of its own size. 15 % and -54 dB: the band's edges ring
// a little.
TEST(Render, StartsAndEndsAtRestWhereTheFingerDoesNot) {
  const auto texture = texture_of(0.12, [](double x) { return 0.02 * std::cos(kTwoPi * 2e3 * x); });
  RenderOptions options;
  const auto soft = render(texture, steady_path(0.01, 0.05, 2), paper(), options);
  options.onset_s = 0;
  const auto hard = render(texture, steady_path(0.01, 0.05, 2), paper(), options);
  ASSERT_TRUE(soft && hard);
  const double inside = rms_between(soft->drive_v, 0.5, 1.5);
  EXPECT_LT(std::abs(soft->drive_v.values.front()), 0.15 * inside);
  EXPECT_LT(std::abs(soft->drive_v.values.back()), 0.15 * inside);
  EXPECT_GT(std::abs(hard->drive_v.values.front()), 0.5 * inside);
  EXPECT_LT(soft->error_db, -54);
}

TEST(Render, ProgressEndsAtOne) {
  std::vector<double> heard;
  const auto texture = sine_texture(0.02, 5e3, 0.01);
  ASSERT_TRUE(render(texture, steady_path(0, 0.04, 0.5), paper(), {}, [&](double f) { heard.push_back(f); }));
  ASSERT_FALSE(heard.empty());
  EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  EXPECT_EQ(heard.back(), 1);
}

}  // namespace
}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// A looped texture keeps its length if its end matches its beginning; otherwise a seam is cut.
#include <gtest/gtest.h>

#include <random>

#include "made_textures.hpp"
#include "playback/prepare/texture_layout.hpp"
#include "playback/render/loop_seam.hpp"
#include "playback/render/render.hpp"

namespace tacto::playback {
namespace {

constexpr double kSeamM = 1e-3;

// As in a file: 32-bit float.
schema::Texture waves(std::size_t samples, double pitch_m, double period_m, double phase) {
  schema::Texture texture;
  texture.signal.pitch_m = pitch_m;
  for (std::size_t i = 0; i < samples; ++i)
    texture.signal.values.push_back(
        static_cast<float>(0.01 * std::sin(kTwoPi * static_cast<double>(i) * pitch_m / period_m + phase)));
  return texture;
}

double seam_of(const schema::Texture& texture) {
  return seam_of_loop(texture.signal, kSeamM);
}

TEST(Loop, WholePeriodsMeetInEveryPhaseAtEveryPitch) {
  for (int step = 0; step < 16; ++step) {
    const double phase = kTwoPi * step / 16;
    EXPECT_EQ(seam_of(waves(36000, 1e-6, 3e-3, phase)), 0) << phase;
    EXPECT_EQ(seam_of(waves(3600, 10e-6, 3e-3, phase)), 0) << phase;
    EXPECT_EQ(seam_of(waves(96, 0.375e-3, 3e-3, phase)), 0) << phase;  // 8 samples a period
    EXPECT_EQ(seam_of(waves(1600, 1e-6, 1.6e-3, phase)), 0) << phase;  // one period, shorter than two seams
  }
}

// A sample too many or too few, a sixth or half a period too many; not exactly at a maximum, where a
// duplicated sample makes no step.
TEST(Loop, WhatDoesNotMeetIsCut) {
  for (int step = 0; step < 16; ++step) {
    const double phase = 0.1 + kTwoPi * step / 16;
    for (const std::size_t samples : {35999U, 36001U, 36500U, 37500U})
      EXPECT_NEAR(seam_of(waves(samples, 1e-6, 3e-3, phase)), kSeamM, 1e-12) << phase << ", " << samples;
  }
  EXPECT_NEAR(seam_of(texture_of(0.02, [](double x) { return x; })), kSeamM, 1e-12);
  EXPECT_NEAR(seam_of(texture_of(1e-3, [](double x) { return x; })), 0.5e-3, 1e-12);  // at most half
}

// A large edge in the texture's middle does not permit one at its ends.
TEST(Loop, AnEdgeElsewhereDoesNotCount) {
  const auto stairs = texture_of(0.03, [](double x) { return x < 0.015 ? 10 * x : 1 + 10 * x; });
  EXPECT_NEAR(seam_of(stairs), kSeamM, 1e-12);
}

// In white noise, end and beginning match as well as any neighbours.
TEST(Loop, NoiseUpToTheLastFrequencyNeedsNoSeam) {
  std::mt19937 random(1);
  int uncut = 0;
  for (int round = 0; round < 50; ++round) {
    schema::Texture noise;
    noise.signal.pitch_m = 50e-6;
    std::normal_distribution<double> normal;
    for (int i = 0; i < 2000; ++i) noise.signal.values.push_back(normal(random));
    uncut += seam_of(noise) == 0;
  }
  EXPECT_GE(uncut, 45);  // two slopes of 130 are changed, each of which may be the largest: 1.5 %
}

TEST(Loop, ASineOfWholePeriodsIsTheEndlessOneToBothEngines) {
  const auto texture = waves(36000, 1e-6, 3e-3, 0.3);
  const auto path = steady_path(0.004, 0.1, 4);  // eleven times around
  for (const Engine engine : {Engine::reference, Engine::kernel}) {
    RenderOptions options;
    options.ends = Ends::loop, options.engine = engine, options.encoder_step_m = 0.1e-6;
    const auto rendering = render(texture, path, *schema::read_transducer("wiertlewski2011"), options);
    ASSERT_TRUE(rendering) << message(rendering.error());
    EXPECT_NEAR(rendering->loop_period_m, 36e-3, 1e-12);
    EXPECT_EQ(rendering->loop_seam_m, 0);
    double worst_m = 0;
    for (std::size_t i = 15000; i <= 25000; ++i) {
      const double x = 0.004 + 0.1 * rendering->target_m.time_s(i);
      const double endless_m = 10e-6 * std::sin(kTwoPi * x / 3e-3 + 0.3);
      worst_m = std::max(worst_m, std::abs(rendering->target_m.values[i] - endless_m));
      worst_m = std::max(worst_m, std::abs(rendering->modelled_m.values[i] - endless_m));
    }
    // The kernel: half a count of 0.1 um is 1e-4 of 3 mm / 2 pi, and its inverse has an error of -60 dB.
    EXPECT_LT(worst_m, (engine == Engine::reference ? 1e-4 : 2e-3) * 10e-6);
  }
}

TEST(Loop, WhatIsCutIsTold) {
  const auto texture = waves(36500, 1e-6, 3e-3, 0);
  RenderOptions options;
  options.ends = Ends::loop;
  const auto transducer = *schema::read_transducer("wiertlewski2011");
  const auto rendering = render(texture, steady_path(0.004, 0.1, 1), transducer, options);
  ASSERT_TRUE(rendering) << message(rendering.error());
  PrepareOptions prepare_options;
  prepare_options.ends = Ends::loop;
  const auto prepared = prepare(texture, transducer, prepare_options);
  ASSERT_TRUE(prepared) << message(prepared.error());
  for (const auto& [period_m, seam_m] : {std::pair{rendering->loop_period_m, rendering->loop_seam_m},
                                         std::pair{prepared->loop_period_m, prepared->loop_seam_m}}) {
    EXPECT_NEAR(period_m, 35.5e-3, 1e-12);
    EXPECT_NEAR(seam_m, kSeamM, 1e-12);
  }
  EXPECT_NEAR(prepared->scale.samples * prepared->pitch_m, 35.5e-3, 1e-12);
}

TEST(Loop, TheSeamOfASessionIsKept) {
  const auto texture = waves(36000, 1e-6, 3e-3, 0);
  const auto cut = as_played(texture, 0, {Ends::loop, kSeamM}, 0, 0.1, "texture");
  const auto whole = as_played(texture, 0, prepared_ends(texture, Ends::loop), 0, 0.1, "texture");
  ASSERT_TRUE(cut && whole);
  const auto at = [](const PlayedSignal& played, double x) {
    return played.signal.values[static_cast<std::size_t>(std::llround((x - played.at_m) / 1e-6))];
  };
  EXPECT_NEAR(at(*cut, 0.036), at(*cut, 0.001), 1e-9);  // 35 mm on
  EXPECT_NEAR(at(*whole, 0.037), at(*whole, 0.001), 1e-9);
  EXPECT_GT(std::abs(at(*cut, 0.037) - at(*whole, 0.037)), 1e-3);
}

}  // namespace
}  // namespace tacto::playback

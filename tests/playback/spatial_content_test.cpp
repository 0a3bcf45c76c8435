// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/spatial_content.hpp"

#include <gtest/gtest.h>

#include "made_textures.hpp"

namespace tacto::playback {
namespace {

double highest_of(double second_per_m, double second_amplitude) {
  const auto texture = texture_of(0.02, [=](double x) {
    return 0.3 + std::sin(kTwoPi * 5e3 * x) + second_amplitude * std::sin(kTwoPi * second_per_m * x);
  });
  return highest_spatial_frequency(texture.signal);
}

// The Hann window over 20 mm spreads a line: the sidelobes' energy (2 / (pi n^3))^2, summed beyond n = 60
// bins of 50 /m, is below -100 dB.
TEST(SpatialContent, EndsAboveMinus100DecibelsOfTheEnergy) {
  EXPECT_NEAR(highest_of(40e3, 1e-6), 5e3, 60 * 50);   // -120 dB: left out
  EXPECT_NEAR(highest_of(40e3, 1e-4), 40e3, 60 * 50);  // -80 dB: kept
}

TEST(SpatialContent, OfAConstantIsZeroAndOfNoiseHalfTheGrid) {
  const auto constant = texture_of(0.01, [](double) { return 0.25; });
  EXPECT_EQ(highest_spatial_frequency(constant.signal), 0);
  unsigned state = 1;
  const auto noise =
      texture_of(0.01, [&](double) { return ((state = state * 1664525U + 1013904223U) >> 16) / 65536.0; });
  EXPECT_GT(highest_spatial_frequency(noise.signal), 499e3);
}

}  // namespace
}  // namespace tacto::playback

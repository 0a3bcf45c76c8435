// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/texture_lookup.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "made_textures.hpp"

namespace tacto::playback {
namespace {

// The bound stated at TextureLookup, from the kernel's series: the error is at least half of it, and never
// larger.
TEST(TextureLookup, InterpolationErrorIsAsStated) {
  for (const double per_m : {15e3, 50e3, 100e3}) {
    const auto texture = sine_texture(0.012, per_m, 1);
    const TextureLookup lookup(texture.signal, 0);
    const double w = kTwoPi * per_m * 1e-6;
    const double bound = (0.0026 + 0.0032 * w) * std::pow(w, 4);
    double worst = 0;
    for (double x = 2e-3; x < 4e-3; x += 0.137e-6)
      worst = std::max(worst, std::abs(lookup(x) - std::sin(kTwoPi * per_m * x)));
    EXPECT_LE(worst, bound) << per_m;
    EXPECT_GE(worst, bound / 2) << per_m;
  }
}

TEST(TextureLookup, LiesWhereItIsLaid) {
  const auto texture = texture_of(0.02, [](double x) { return x; });
  const TextureLookup lookup(texture.signal, 0.1);
  EXPECT_NEAR(lookup(0.105), 0.005, 1e-12);
  EXPECT_FALSE(lookup.contains(0.0999));
  EXPECT_FALSE(lookup.contains(0.1201));
  EXPECT_TRUE(lookup.contains(0.11));
}

// A constant texture shows the fade: zero at the end, half after half a millimetre, full after one.
TEST(TextureLookup, EndsFadeByARaisedCosine) {
  const auto texture = texture_of(0.02, [](double) { return 2.0; });
  const TextureLookup lookup(texture.signal, 0);
  EXPECT_EQ(lookup.fade_m(), 1e-3);
  EXPECT_EQ(lookup(-1e-9), 0);
  EXPECT_NEAR(lookup(0), 0, 1e-12);
  EXPECT_NEAR(lookup(0.5e-3), 1, 1e-9);
  EXPECT_EQ(lookup(1e-3), 2);
  EXPECT_NEAR(lookup(0.0195), 1, 1e-9);
  EXPECT_EQ(lookup(0.0201), 0);
}

TEST(TextureLookup, AShortTextureFadesOverATenth) {
  const auto texture = texture_of(0.002, [](double) { return 1.0; });
  EXPECT_NEAR(TextureLookup(texture.signal, 0).fade_m(), 0.2e-3, 1e-12);
}

}  // namespace
}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// Textures with closed forms, for tests of spectrograms and pictures.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "data-schema/texture/texture.hpp"

namespace tacto::spatial::samples {

inline schema::Texture texture_of(std::vector<double> values, double pitch_m = 1e-6) {
  schema::Texture texture;
  texture.signal = {pitch_m, 0, std::move(values)};
  return texture;
}

/// amplitude_n sin(2 pi k x), over `count` samples.
inline schema::Texture sine(double amplitude_n, double frequency_per_m, std::size_t count,
                            double pitch_m = 1e-6) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] =
        amplitude_n * std::sin(2 * std::numbers::pi * frequency_per_m * static_cast<double>(i) * pitch_m);
  return texture_of(std::move(values), pitch_m);
}

/// Uniform noise between -1 and 1, the same on every machine (Numerical Recipes' 64-bit generator).
inline schema::Texture noise(std::size_t count, double pitch_m = 1e-6) {
  std::vector<double> values(count);
  std::uint64_t state = 12345;
  for (double& value : values) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    value = static_cast<double>(state >> 11) * 0x1p-52 - 1;
  }
  return texture_of(std::move(values), pitch_m);
}

}  // namespace tacto::spatial::samples

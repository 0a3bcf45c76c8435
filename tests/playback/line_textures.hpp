// SPDX-License-Identifier: GPL-3.0-or-later
// Loops that consist of lines, so that the content of a level has a closed form at any position.
#pragma once

#include <cmath>
#include <random>

#include "playback/prepare/prepare.hpp"
#include "tests/playback/made_textures.hpp"

namespace tacto::playback {

struct TextureLine {
  double per_m = 0, phase = 0, amplitude_n = 0;
};

/// 20 mm on a 10 um grid, repeated.
struct LineTexture {
  static constexpr double kLengthM = 20e-3, kPitchM = 10e-6;
  std::vector<TextureLine> lines;

  schema::Texture sampled() const {
    schema::Texture texture;
    texture.signal = {kPitchM, 0, std::vector<double>(2000)};
    for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
      for (const TextureLine& line : lines)
        texture.signal.values[i] +=
            line.amplitude_n * std::sin(kTwoPi * line.per_m * texture.signal.position_m(i) + line.phase);
    return texture;
  }
  /// The kernel's target at a position and speed: levels pass finest / 2^(n/2) unchanged and fall to zero at
  /// 1.25 times that by a raised cosine (make_pyramid); the kernel fades between two of them by its own
  /// measure of speed (core::half_octaves).
  double read(double position_m, double speed_ratio, double finest_per_m, int levels) const {
    const double coarseness = levels > 1 ? core::half_octaves(static_cast<float>(speed_ratio)) : 0;
    const int coarser = static_cast<int>(coarseness);
    const double fade = coarseness < 1 ? 0 : coarseness - coarser;
    double sum = 0;
    for (const TextureLine& line : lines) {
      const double fine = passed(line.per_m, finest_per_m, coarser < 1 ? 0 : coarser - 1);
      const double coarse = fade > 0 && coarser < levels ? passed(line.per_m, finest_per_m, coarser) : 0;
      sum += line.amplitude_n * ((1 - fade) * fine + fade * coarse) *
             std::sin(kTwoPi * line.per_m * position_m + line.phase);
    }
    return sum;
  }

 private:
  static double passed(double per_m, double finest_per_m, int level) {
    const double beside = (per_m / (finest_per_m * std::exp2(-0.5 * level)) - 1) / 0.25;
    return 0.5 + 0.5 * std::cos(kPi * std::clamp(beside, 0.0, 1.0));
  }
  static constexpr double kPi = std::numbers::pi;
};

/// Up to six lines, or thirty as band-limited noise, from a twelfth of finest_per_m up to finest_per_m.
inline LineTexture random_lines(std::mt19937& random, double finest_per_m, bool noise) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const int count = noise ? 30 : std::uniform_int_distribution<>(1, 6)(random);
  LineTexture texture;
  for (int i = 0; i < count; ++i) {
    const double asked_per_m = i == 0 ? finest_per_m : finest_per_m / std::exp(uniform(0, std::log(12)));
    const double per_m = std::round(asked_per_m * LineTexture::kLengthM) / LineTexture::kLengthM;
    texture.lines.push_back({per_m, uniform(0, kTwoPi), 0.02 * uniform(0.3, 1) / std::sqrt(count)});
  }
  return texture;
}

}  // namespace tacto::playback

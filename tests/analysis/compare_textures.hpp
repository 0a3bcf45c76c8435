// SPDX-License-Identifier: GPL-3.0-or-later
// Textures with known spectra, for the tests of `compare`.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

inline schema::Texture made_texture(double pitch_m, std::size_t samples,
                                    const std::function<double(double)>& force_n) {
  schema::Texture texture;
  texture.signal.pitch_m = pitch_m;
  for (std::size_t i = 0; i < samples; ++i)
    texture.signal.values.push_back(force_n(texture.signal.position_m(i)));
  return texture;
}

/// Band-limited noise as a sum of `lines` cosines of random phase from `low` to `high` 1/m, RMS 1: the same
/// surface with any pitch, also between samples.
class RandomSurface {
 public:
  RandomSurface(unsigned seed, double low, double high, int lines = 400)
      : low_(low), step_((high - low) / lines) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> part(0, 1);
    for (int i = 0; i < lines; ++i) phases_.push_back({part(random), 2 * std::numbers::pi * part(random)});
  }
  double operator()(double x) const {
    double sum = 0;
    for (std::size_t i = 0; i < phases_.size(); ++i)
      sum += std::cos(2 * std::numbers::pi * frequency(i) * x + phases_[i].second);
    return sum * std::sqrt(2.0 / static_cast<double>(phases_.size()));
  }

 private:
  double frequency(std::size_t i) const { return low_ + (static_cast<double>(i) + phases_[i].first) * step_; }
  double low_, step_;
  std::vector<std::pair<double, double>> phases_;
};

/// White samples, RMS 1.
inline schema::Texture white_texture(unsigned seed, std::size_t samples, double pitch_m = 50e-6) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return made_texture(pitch_m, samples, [&](double) { return normal(random); });
}

inline schema::Texture scaled(schema::Texture texture, double gain) {
  for (double& value : texture.signal.values) value *= gain;
  return texture;
}

}  // namespace tacto::analysis

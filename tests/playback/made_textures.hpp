// SPDX-License-Identifier: GPL-3.0-or-later
// Textures and paths with a closed form, for the tests of this folder.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "data-schema/texture/texture.hpp"
#include "playback/model/finger_path.hpp"

namespace tacto::playback {

inline constexpr double kTwoPi = 2 * std::numbers::pi;

/// Force over position on a 1 um grid.
inline schema::Texture texture_of(double length_m, const std::function<double(double)>& force_n) {
  schema::Texture texture;
  texture.signal.pitch_m = 1e-6;
  const auto samples = static_cast<std::size_t>(std::llround(length_m / 1e-6)) + 1;
  for (std::size_t i = 0; i < samples; ++i)
    texture.signal.values.push_back(force_n(texture.signal.position_m(i)));
  return texture;
}

inline schema::Texture sine_texture(double length_m, double frequency_per_m, double amplitude_n) {
  return texture_of(length_m, [=](double x) { return amplitude_n * std::sin(kTwoPi * frequency_per_m * x); });
}

/// Straight ahead at one speed.
inline FingerPath steady_path(double from_m, double speed_mps, double duration_s) {
  return {{0, duration_s}, {from_m, from_m + speed_mps * duration_s}};
}

/// From one position to another and back, at rest at both ends: x = from + travel / 2 (1 - cos(2 pi t /
/// duration)).
inline FingerPath there_and_back(double from_m, double travel_m, double duration_s) {
  FingerPath path;
  for (int i = 0; i <= 2000; ++i) {
    const double time_s = duration_s * i / 2000;
    path.time_s.push_back(time_s);
    path.position_m.push_back(from_m + travel_m / 2 * (1 - std::cos(kTwoPi * time_s / duration_s)));
  }
  return path;
}

}  // namespace tacto::playback

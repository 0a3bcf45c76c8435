// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes over a surface with known lines, plus hums and resonances that do not belong to it: force(t) =
// surface(x(t)) + hum(t) + noise, as textures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "data-schema/texture/texture.hpp"

namespace tacto::spatial::samples {

/// The same numbers with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}
  double even(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) + 0.5) * 0x1p-53;
  }
  /// Uniform in the logarithm.
  double ratio(double low, double high) { return low * std::pow(high / low, even(0, 1)); }
  double normal() { return std::sqrt(-2 * std::log(even(0, 1))) * std::cos(even(0, 2 * std::numbers::pi)); }
  bool chance(double part) { return even(0, 1) < part; }

 private:
  std::mt19937_64 generator_;
};

struct Line {
  double frequency = 0;  ///< 1/m or Hz
  double amplitude = 0;
};

/// The motion of a finger: a constant speed that varies by `waver`, relative, `wavers_hz` times per second.
struct Stroke {
  double speed_mps = 0, length_m = 0, waver = 0, wavers_hz = 0, phase = 0;
  double speed(double t) const {
    return speed_mps * (1 + waver * std::sin(2 * std::numbers::pi * wavers_hz * t + phase));
  }
};

struct World {
  std::vector<Line> surface, hums;
  double noise = 0;         ///< white, RMS per sample of the grid
  double rough = 0;         ///< a random surface, the same in each stroke
  double resonance_hz = 0;  ///< of noise through a resonator
  double resonance_rms = 0, resonance_q = 30;
};

inline constexpr double kGrid_m = 20e-6;
inline constexpr double kLow_hz = 15, kHigh_hz = 500;

/// Noise through a resonator of second order, by time steps of `interval_s`; RMS 1.
inline std::vector<double> resonant_noise(Dice& dice, double frequency_hz, double q, double interval_s,
                                          std::size_t count) {
  const double radius = std::exp(-std::numbers::pi * frequency_hz / q * interval_s);
  const double turn = 2 * std::cos(2 * std::numbers::pi * frequency_hz * interval_s) * radius;
  std::vector<double> values(count);
  double last = 0, before = 0, power = 0;
  for (double& value : values) {
    value = turn * last - radius * radius * before + dice.normal();
    before = last;
    last = value;
    power += value * value;
  }
  for (double& value : values) value /= std::sqrt(power / static_cast<double>(count));
  return values;
}

/// The texture of one stroke. The surface's amplitudes vary by 2 dB from stroke to stroke, those of hums do
/// not.
inline schema::Texture stroke_texture(const World& world, const Stroke& stroke, std::uint64_t seed) {
  Dice dice(seed), ground(99);
  const auto count = static_cast<std::size_t>(stroke.length_m / kGrid_m);
  constexpr double kStep_s = 1e-4;
  const auto steps =
      static_cast<std::size_t>(stroke.length_m / stroke.speed_mps / (1 - stroke.waver) / kStep_s) + 10;
  const auto ringing = world.resonance_rms > 0
                           ? resonant_noise(dice, world.resonance_hz, world.resonance_q, kStep_s, steps)
                           : std::vector<double>(steps, 0.0);
  std::vector<double> gains, phases;
  for (std::size_t n = 0; n < world.surface.size(); ++n) gains.push_back(std::pow(10, 0.1 * dice.normal()));
  for (std::size_t n = 0; n < world.hums.size(); ++n) phases.push_back(dice.even(0, 2 * std::numbers::pi));
  schema::Texture texture;
  texture.signal.pitch_m = kGrid_m;
  double t = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) * kGrid_m;
    double force = world.noise * dice.normal() + world.rough * ground.normal();
    for (std::size_t n = 0; n < world.surface.size(); ++n)
      force += gains[n] * world.surface[n].amplitude *
               std::sin(2 * std::numbers::pi * world.surface[n].frequency * x + static_cast<double>(n));
    for (std::size_t n = 0; n < world.hums.size(); ++n)
      force +=
          world.hums[n].amplitude * std::sin(2 * std::numbers::pi * world.hums[n].frequency * t + phases[n]);
    force += world.resonance_rms * ringing[std::min(steps - 1, static_cast<std::size_t>(t / kStep_s))];
    texture.signal.values.push_back(force);
    if (i % 5 == 0) texture.valid_band.push_back({x, kLow_hz / stroke.speed(t), kHigh_hz / stroke.speed(t)});
    t += kGrid_m / stroke.speed(t);
  }
  texture.source.recording = "simulated.json";
  texture.source.filter = "fourier";
  texture.source.low_hz = kLow_hz;
  texture.source.high_hz = kHigh_hz;
  texture.source.mean_speed_mps = stroke.length_m / t;
  return texture;
}

}  // namespace tacto::spatial::samples

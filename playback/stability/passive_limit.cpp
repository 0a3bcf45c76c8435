// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/stability/passive_limit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::playback {
namespace {


// L of the header.
double held_ticks(double delay_ticks) {
  const double mean = delay_ticks + 0.5, part = delay_ticks - std::floor(delay_ticks);
  return (mean + std::sqrt(mean * mean + part * (1 - part))) / 2;
}

// c' of the header.
double friction_left_n(const schema::DeviceAxis& axis, const TickTiming& timing, double damping) {
  return axis.coulomb_n - damping * axis.encoder_step_m / timing.period_s;
}

}  // namespace

double passive_stiffness_limit(const schema::DeviceAxis& axis, const TickTiming& timing, double damping,
                               double speed_mps) {
  const double friction_n = friction_left_n(axis, timing, damping), step_m = axis.encoder_step_m;
  if (friction_n < 0) return 0;
  const double left = axis.viscous_n_s_per_m - damping,
               held_s = held_ticks(timing.delay_ticks) * timing.period_s;
  const double at_rest = step_m > 0 ? 2 * friction_n / step_m : INFINITY;
  const double moving = std::isinf(speed_mps)
                            ? left / held_s
                            : (left * speed_mps + friction_n) / (held_s * speed_mps + step_m / 2);
  return std::max(0.0, std::min(at_rest, moving));
}

double passive_damping_needed(const TickTiming& timing, double stiffness, double damping) {
  return held_ticks(timing.delay_ticks) * stiffness * timing.period_s + damping;
}

double largest_passive_speed_mps(const schema::DeviceAxis& axis, const TickTiming& timing, double stiffness,
                                 double damping) {
  const double friction_n = friction_left_n(axis, timing, damping) - stiffness * axis.encoder_step_m / 2;
  if (friction_n < 0) return 0;
  const double lacking = passive_damping_needed(timing, stiffness, damping) - axis.viscous_n_s_per_m;
  return lacking > 0 ? friction_n / lacking : INFINITY;
}

double friction_basin_m(const schema::DeviceAxis& axis, const TickTiming& timing, double stiffness,
                        double damping) {
  const double frequency = std::sqrt(stiffness / axis.mass_kg);
  const double growing =
      stiffness * timing.period_s * (0.5 + timing.delay_ticks) - axis.viscous_n_s_per_m - damping;
  if (frequency * timing.period_s > 0.2) return NAN;
  return growing > 0 ? 4 * axis.coulomb_n / (std::numbers::pi * frequency * growing) : INFINITY;
}

}  // namespace tacto::playback

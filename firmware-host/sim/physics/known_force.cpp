// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/known_force.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::firmware_host {
namespace {

// The last bit of a power depends on the machine, so frequencies are rounded to a microhertz.
constexpr double kFrequencyStepHz = 1e-6;

double tone_hz(const ForcePlan& plan, int k) {
  if (k == 0) return plan.low_hz;
  const double hz = plan.low_hz * std::pow(plan.high_hz / plan.low_hz, k / (plan.tones - 1.0));
  return std::floor(hz / kFrequencyStepHz + 0.5) * kFrequencyStepHz;
}

}  // namespace

// Reduced to a quarter turn; Taylor series, with a next term of 3e-16.
double sine_of_turns(double turns) {
  const double part = turns - std::floor(turns + 0.5);
  const double quarter = part > 0.25 ? 0.5 - part : part < -0.25 ? -0.5 - part : part;
  const double x = 2 * std::numbers::pi * quarter, square = x * x;
  double sum = 1;
  for (int n = 19; n > 1; n -= 2) sum = 1 - sum * square / (n * (n - 1));
  return x * sum;
}

KnownForce::KnownForce(const ForcePlan& plan) : plan_(plan) {
  const int tones = plan.shape == ForceShape::multisine ? plan.tones : 1;
  for (int k = 0; k < tones; ++k) tones_.push_back({tone_hz(plan, k), k * k / (2.0 * tones)});
}

// Each direction takes sweep_s and (low + high) / 2 x sweep_s turns; the second is the mirror image of the
// first.
double KnownForce::chirp_turns(double time_s) const {
  const double growth_hz = (plan_.high_hz - plan_.low_hz) / plan_.sweep_s;
  const double ways = std::floor(time_s / plan_.sweep_s), s = time_s - ways * plan_.sweep_s;
  const bool back = ways - 2 * std::floor(ways / 2) > 0;
  const double begin_hz = back ? plan_.high_hz : plan_.low_hz;
  const double before = ways * plan_.sweep_s * (plan_.low_hz + plan_.high_hz) / 2;
  return before + s * (begin_hz + (back ? -growth_hz : growth_hz) * s / 2);
}

// The rise is so slow that the sensor, with its high-pass at 8 Hz, responds only to the cut.
double KnownForce::pull_n(double time_s) const {
  if (time_s >= plan_.sweep_s) return 0;
  const double hung = std::min(1.0, time_s / (0.75 * plan_.sweep_s));
  return plan_.amplitude_n * (1 - sine_of_turns(0.25 + hung / 2)) / 2;
}

double KnownForce::at(double time_s) const {
  if (plan_.shape == ForceShape::release) return pull_n(time_s);
  if (plan_.shape == ForceShape::chirp) return plan_.amplitude_n * sine_of_turns(chirp_turns(time_s));
  double sum = 0;
  for (const Tone& tone : tones_) sum += sine_of_turns(tone.frequency_hz * time_s + tone.phase_turns);
  return plan_.amplitude_n * sum;
}

}  // namespace tacto::firmware_host

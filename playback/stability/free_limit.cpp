// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/stability/free_limit.hpp"

#include <algorithm>
#include <cmath>

#include "playback/stability/sampled_spring.hpp"

namespace tacto::playback {
namespace {

/// (u - 1 + e^-u) / u^2, by its series where the difference would lose digits.
double ramp_of(double u) {
  if (u > 0.1) return (u + std::expm1(-u)) / (u * u);
  double sum = 0, term = 0.5;
  for (int n = 3; n < 12; ++n) {
    sum += term;
    term *= -u / n;
  }
  return sum;
}

}  // namespace

double free_stiffness_limit(double mass_kg, double damping_n_s_per_m, double period_s, double delay_ticks) {
  if (damping_n_s_per_m <= 0) return 0;
  if (delay_ticks > 0) return stiffness_limit({mass_kg, damping_n_s_per_m, 0}, {period_s, delay_ticks}, 0);
  const double u = damping_n_s_per_m * period_s / mass_kg, lost = -std::expm1(-u), e = 1 - lost;
  const double unit = period_s * period_s / mass_kg;  // of p and q
  const double p = unit * ramp_of(u), q = unit * lost / u * (lost / u) - p * e;
  const double slow = lost / q;
  return p > q ? std::min(slow, 2 * (1 + e) / (p - q)) : slow;
}

}  // namespace tacto::playback

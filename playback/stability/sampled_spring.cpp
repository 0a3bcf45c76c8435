// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/stability/sampled_spring.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "firmware-host/sim/planar/linear_motion.hpp"

namespace tacto::playback {
namespace {

using Phasor = std::complex<double>;
using firmware_host::PlaceAndSpeed;

PlaceAndSpeed after_unit_force(const HeldMass& held, double time_s) {
  return firmware_host::LinearMotion{held.mass_kg, held.damping_n_s_per_m, held.stiffness_n_per_m, 1, 0}
      .after({}, time_s);
}

/// The characteristic polynomial fixed + K slope; the names are those of the header.
class Characteristic {
 public:
  Characteristic(const HeldMass& held, const TickTiming& timing, double damping)
      : whole_ticks_(static_cast<int>(timing.delay_ticks)), damping_per_tick_(damping / timing.period_s) {
    const double m = held.mass_kg, b = held.damping_n_s_per_m, k = held.stiffness_n_per_m;
    const double part = timing.delay_ticks - whole_ticks_;
    const auto [g, h] = after_unit_force(held, timing.period_s);
    const auto [g1, h1] = after_unit_force(held, (1 - part) * timing.period_s);
    d1_ = b * h + 2 * k * g;
    d0_ = k * (g * (b * h + k * g) + m * h * h);
    const double kept = b * h + k * g;
    // N(z) = (w + kept) (w g1 + g) + m h (w h1 + h), since g1 + g0 = g
    n2_ = g1;
    n1_ = g + kept * g1 + m * h * h1;
    n0_ = kept * g + m * h * h;
  }

  struct Value {
    Phasor fixed, slope;
  };
  Value at(double theta) const {
    // Sines and cosines take most of the time of a limit: one of each, without a delay.
    const double half = std::sin(theta / 2);
    const Phasor w{-2 * half * half, 2 * half * std::cos(theta / 2)};  // z - 1 without cancellation
    const Phasor z = 1.0 + w, n = (n2_ * w + n1_) * w + n0_;
    const Phasor power = whole_ticks_ == 0 ? z * z : std::polar(1.0, (whole_ticks_ + 2) * theta);
    return {((w + d1_) * w + d0_) * power + damping_per_tick_ * w * n, z * n};
  }

  /// Coefficients at this K, that of the highest power first.
  std::vector<double> coefficients(double stiffness) const {
    std::vector<double> all(static_cast<std::size_t>(whole_ticks_) + 5);
    const double d[3] = {1, d1_ - 2, 1 - d1_ + d0_};
    const double n[3] = {n2_, n1_ - 2 * n2_, n2_ - n1_ + n0_};
    for (std::size_t i = 0; i < 3; ++i) {
      all[i] += d[i];
      all[all.size() - 4 + i] += (stiffness + damping_per_tick_) * n[i];
      all[all.size() - 3 + i] -= damping_per_tick_ * n[i];
    }
    return all;
  }

  std::vector<double> scanned_angles() const {
    std::vector<double> angles;
    for (double theta = 1e-8; theta < 0.1; theta *= 1.05) angles.push_back(theta);
    const int steps = 64 * (whole_ticks_ + 4);
    for (int i = steps / 32; i <= steps; ++i) angles.push_back(std::numbers::pi * i / steps);
    std::ranges::sort(angles);
    return angles;
  }

 private:
  int whole_ticks_;
  double damping_per_tick_;
  double d1_, d0_, n2_, n1_, n0_;  // D and N as polynomials in w
};

/// Schur and Cohn: all zeros are within the unit circle if and only if each reflection coefficient is.
bool all_zeros_within(std::vector<double> p) {
  while (p.size() > 1) {
    const double reflection = p.back() / p.front();
    if (!(std::abs(reflection) < 1)) return false;
    std::vector<double> shorter(p.size() - 1);
    for (std::size_t i = 0; i < shorter.size(); ++i) shorter[i] = p[i] - reflection * p[p.size() - 1 - i];
    p = std::move(shorter);
  }
  return true;
}

/// Above 0 on one side of a crossing and below 0 on the other.
double crossing_side(const Characteristic& polynomial, double theta) {
  const auto [fixed, slope] = polynomial.at(theta);
  return (fixed * std::conj(slope)).imag();
}

double stiffness_at(const Characteristic& polynomial, double theta) {
  const auto [fixed, slope] = polynomial.at(theta);
  return -(fixed * std::conj(slope)).real() / std::norm(slope);
}

double crossing_between(const Characteristic& polynomial, double from, double to) {
  const bool start = crossing_side(polynomial, from) > 0;
  for (double middle = (from + to) / 2; middle > from && middle < to; middle = (from + to) / 2)
    ((crossing_side(polynomial, middle) > 0) == start ? from : to) = middle;
  return from;
}

}  // namespace

double stiffness_limit(const HeldMass& held, const TickTiming& timing, double virtual_damping_n_s_per_m) {
  if (held.damping_n_s_per_m <= 0 && virtual_damping_n_s_per_m <= 0)
    return 0;  // a sampled spring gives energy
  const Characteristic polynomial(held, timing, virtual_damping_n_s_per_m);
  double least = std::numeric_limits<double>::infinity();
  const auto cross = [&](double theta) {
    if (const double stiffness = stiffness_at(polynomial, theta); stiffness > 0)
      least = std::min(least, stiffness);
  };
  const std::vector<double> angles = polynomial.scanned_angles();
  bool last = crossing_side(polynomial, angles[0]) > 0;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    const bool side = crossing_side(polynomial, angles[i]) > 0;
    if (side != last) cross(crossing_between(polynomial, angles[i - 1], angles[i]));
    last = side;
  }
  cross(std::numbers::pi);
  // Without a virtual damper a small K is stable, because the damping of the mass dissipates energy at all
  // times.
  if (virtual_damping_n_s_per_m > 0 && !all_zeros_within(polynomial.coefficients(std::min(least / 2, 1e300))))
    return 0;
  return least;
}

}  // namespace tacto::playback

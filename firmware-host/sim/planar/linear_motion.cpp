// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/planar/linear_motion.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace tacto::firmware_host {
namespace {

constexpr int kMostTerms = 40;  // |root x time| is 1 at most: the 40th term is below 1e-40 of the first

// x = sum of c_n t^n: c_(n+2) follows from the equation of motion, power by power.
PlaceAndSpeed series(const LinearMotion& motion, PlaceAndSpeed start, double t) {
  const double b = motion.damping_n_s_per_m / motion.mass_kg, k = motion.stiffness_n_per_m / motion.mass_kg;
  // Terms c_n t^n and c_(n+1) t^(n+1), and the sums of x and of t x'.
  double low = start.place_m, high = start.speed_mps * t;
  double place = low + high, moved = high;
  for (int n = 0; n < kMostTerms; ++n) {
    double forced = n == 0 ? motion.force_n : 0;
    if (n == 1) forced = motion.force_rate_n_per_s * t;
    const double next = (forced / motion.mass_kg * t * t - b * t * (n + 1) * high - k * t * t * low) /
                        ((n + 1.0) * (n + 2.0));
    place += next;
    moved += (n + 2) * next;
    low = high;
    high = next;
    if (n > 1 && low == 0 && high == 0) break;
  }
  return {place, t > 0 ? moved / t : start.speed_mps};
}

// Bisection: `value` is monotone between the ends and has different signs there.
double zero_between(const std::function<double(double)>& value, double low, double high) {
  const bool rises = value(high) > 0;
  while (true) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return high;
    ((value(middle) > 0) == rises ? high : low) = middle;
  }
}

// The same as time_of_stop_s() in a piece with at most one zero of the acceleration.
double stop_in_piece_s(const LinearMotion& motion, PlaceAndSpeed start, double sign, double piece_s) {
  const auto speed = [&](double t) { return sign * series(motion, start, t).speed_mps; };
  const auto acceleration = [&](double t) { return motion.acceleration_mps2(series(motion, start, t), t); };
  // A start from rest at the edge of friction: the acceleration begins at zero, and rounding may give it the
  // wrong sign.
  if (start.speed_mps == 0 && sign * acceleration(0) <= 0) return std::numeric_limits<double>::infinity();
  double turn_s = piece_s;
  if (acceleration(0) * acceleration(piece_s) < 0) turn_s = zero_between(acceleration, 0, piece_s);
  if (speed(turn_s) < 0) return zero_between(speed, 0, turn_s);
  return speed(piece_s) < 0 ? zero_between(speed, turn_s, piece_s) : std::numeric_limits<double>::infinity();
}

}  // namespace

double LinearMotion::longest_piece_s() const {
  const double half = damping_n_s_per_m / (2 * mass_kg), square = stiffness_n_per_m / mass_kg;
  const double largest = half + std::sqrt(std::max(half * half, square));
  return largest > 0 ? 1 / largest : std::numeric_limits<double>::infinity();
}

LinearMotion LinearMotion::from(double time_s) const {
  LinearMotion later = *this;
  later.force_n += force_rate_n_per_s * time_s;
  return later;
}

PlaceAndSpeed LinearMotion::after(PlaceAndSpeed start, double time_s) const {
  const double pieces = std::max(1.0, std::ceil(time_s / longest_piece_s()));
  const double piece_s = time_s / pieces;
  for (double i = 0; i < pieces; ++i) start = series(from(i * piece_s), start, piece_s);
  return start;
}

double time_of_stop_s(const LinearMotion& motion, PlaceAndSpeed start, double sign, double duration_s) {
  const double pieces = std::max(1.0, std::ceil(duration_s / motion.longest_piece_s()));
  const double piece_s = duration_s / pieces;
  for (double i = 0; i < pieces; ++i) {
    const LinearMotion rest = motion.from(i * piece_s);
    const double stop_s = stop_in_piece_s(rest, start, sign, piece_s);
    if (stop_s <= piece_s) return i * piece_s + stop_s;
    start = series(rest, start, piece_s);
  }
  return duration_s;
}

}  // namespace tacto::firmware_host

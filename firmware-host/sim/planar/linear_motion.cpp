// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/planar/linear_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tacto::firmware_host {
namespace {

constexpr double kUnseen = 0x1p-60;  // of a sum: far below half of its last bit
constexpr int kMostTerms = 40;       // |root x time| is 1 at most: the 40th term is below 1e-40 of the first

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
    // The terms that follow are smaller, because |b t| <= 2 and |k t^2| <= 1: they do not change the sums.
    const double largest = std::max(std::abs(low), std::abs(high)) / kUnseen;
    if (n > 1 && largest <= std::abs(place) && (n + 3) * largest <= std::abs(moved)) break;
  }
  return {place, t > 0 ? moved / t : start.speed_mps};
}

constexpr double kMostPieces = 256;

// The same for very many pieces, as of a light mass on a strong damper: the change of the state over a piece
// is linear in the state before it, change = D state, and over twice the time it is (2 D + D D) state. D
// instead of 1 + D, because rounding beside the 1 would grow with the number of pieces. State: place, step x
// speed, step^2 / mass x force, and step^3 / mass x its rate.
PlaceAndSpeed by_doubling(const LinearMotion& motion, PlaceAndSpeed start, double time_s, double pieces) {
  const int doublings = static_cast<int>(std::ceil(std::log2(pieces)));
  const double step_s = std::ldexp(time_s, -doublings), per_mass = step_s / motion.mass_kg;
  const double damping = motion.damping_n_s_per_m * per_mass;
  const double stiffness = motion.stiffness_n_per_m * step_s * per_mass;
  // A place of 1 is a force of -stiffness on the change of the place.
  const PlaceAndSpeed by_place = series({1, damping, stiffness, -stiffness, 0}, {0, 0}, 1),
                      by_speed = series({1, damping, stiffness, 0, 0}, {0, 1}, 1),
                      by_force = series({1, damping, stiffness, 1, 0}, {0, 0}, 1),
                      by_rate = series({1, damping, stiffness, 0, 1}, {0, 0}, 1);
  std::array<std::array<double, 4>, 4> change{
      {{by_place.place_m, by_speed.place_m, by_force.place_m, by_rate.place_m},
       {by_place.speed_mps, by_speed.speed_mps - 1, by_force.speed_mps, by_rate.speed_mps},
       {0, 0, 0, 1},
       {0, 0, 0, 0}}};
  for (int i = 0; i < doublings; ++i) {
    const auto once = change;
    for (std::size_t to = 0; to < 4; ++to)
      for (std::size_t from = 0; from < 4; ++from) {
        change[to][from] = 2 * once[to][from];
        for (std::size_t by = 0; by < 4; ++by) change[to][from] += once[to][by] * once[by][from];
      }
  }
  const double state[] = {start.place_m, start.speed_mps * step_s, motion.force_n * step_s * per_mass,
                          motion.force_rate_n_per_s * step_s * step_s * per_mass};
  double place = state[0], moved = state[1];
  for (std::size_t from = 0; from < 4; ++from) {
    place += change[0][from] * state[from];
    moved += change[1][from] * state[from];
  }
  return {place, moved / step_s};
}

// Bisection: `value` is monotone between the ends and has different signs there.
double zero_between(const auto& value, double low, double high) {
  const bool rises = value(high) > 0;
  while (true) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return high;
    ((value(middle) > 0) == rises ? high : low) = middle;
  }
}

// The acceleration a follows a'' + b a' + k a = 0 (per mass). With roots r of at most 1 / piece_s, none of
// which grows, it is a(0) C + a'(0) S with |S| <= t and |C| <= 1 + |r| t <= 2: the speed changes by at most
// t (2 |a(0)| + |a'(0)| t).
bool is_too_fast_to_stop(const LinearMotion& motion, PlaceAndSpeed start, double sign, double piece_s) {
  const double acceleration = motion.acceleration_mps2(start, 0);
  const double jerk = (motion.force_rate_n_per_s - motion.stiffness_n_per_m * start.speed_mps -
                       motion.damping_n_s_per_m * acceleration) /
                      motion.mass_kg;
  constexpr double kRounding = 1.001;
  return sign * start.speed_mps >
         kRounding * piece_s * (2 * std::abs(acceleration) + std::abs(jerk) * piece_s);
}

// The same as time_of_stop_s() in a piece with at most one zero of the acceleration.
double stop_in_piece_s(const LinearMotion& motion, PlaceAndSpeed start, double sign, double piece_s) {
  if (is_too_fast_to_stop(motion, start, sign, piece_s)) return std::numeric_limits<double>::infinity();
  const auto speed = [&](double t) { return sign * series(motion, start, t).speed_mps; };
  const auto acceleration = [&](double t) { return motion.acceleration_mps2(series(motion, start, t), t); };
  // A start from rest at the edge of friction: the acceleration begins at zero, and rounding may give it the
  // wrong sign.
  if (start.speed_mps == 0 && sign * acceleration(0) <= 0) return std::numeric_limits<double>::infinity();
  const double first = sign * acceleration(0), end = speed(piece_s);
  if (first > 0 && end >= 0) return std::numeric_limits<double>::infinity();  // at most one turn: a maximum
  double turn_s = piece_s;
  if (first * sign * acceleration(piece_s) < 0) turn_s = zero_between(acceleration, 0, piece_s);
  if (speed(turn_s) < 0) return zero_between(speed, 0, turn_s);
  return end < 0 ? zero_between(speed, turn_s, piece_s) : std::numeric_limits<double>::infinity();
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
  if (pieces > kMostPieces) return by_doubling(*this, start, time_s, pieces);
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

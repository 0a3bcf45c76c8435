// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/planar/axis_motion.hpp"

#include <cassert>
#include <cmath>
#include <limits>

namespace tacto::firmware_host {
namespace {

// Of one call: a bound for the loop, far above what a spring and a damper can do in it.
constexpr int kMostEvents = 100'000;

LinearMotion frictionless(const AxisBody& body, double motor_force_n, HandPlace hand) {
  return {.mass_kg = body.mass_kg,
          .damping_n_s_per_m = body.viscous_n_s_per_m + body.hand_damping_n_s_per_m,
          .stiffness_n_per_m = body.hand_stiffness_n_per_m,
          .force_n = motor_force_n + body.hand_stiffness_n_per_m * hand.place_m +
                     body.hand_damping_n_s_per_m * hand.speed_mps,
          .force_rate_n_per_s = body.hand_stiffness_n_per_m * hand.speed_mps};
}

// How long a resting axis stays at rest: until the driving force leaves the band of Coulomb friction.
double rest_s(const LinearMotion& motion, double coulomb_n, double place_m) {
  const double driving_n = motion.driving_force_n(0, place_m), rate = motion.force_rate_n_per_s;
  if (std::abs(driving_n) > coulomb_n) return 0;
  if (rate == 0) return std::numeric_limits<double>::infinity();
  return (std::copysign(coulomb_n, rate) - driving_n) / rate;
}

// Of the motion that begins: the driving force's, and at the edge of the band that of its change.
double sign_from_rest(const LinearMotion& motion, double coulomb_n, double place_m) {
  const double driving_n = motion.driving_force_n(0, place_m);
  const bool at_edge = std::abs(driving_n) <= coulomb_n;
  return std::copysign(1, at_edge ? motion.force_rate_n_per_s : driving_n);
}

}  // namespace

PlaceAndSpeed moved(const AxisBody& body, PlaceAndSpeed state, double motor_force_n, HandPlace hand,
                    double duration_s) {
  LinearMotion motion = frictionless(body, motor_force_n, hand);
  if (body.coulomb_n == 0) return motion.after(state, duration_s);
  double left_s = duration_s;
  for (int event = 0; left_s > 0 && event < kMostEvents; ++event) {
    if (state.speed_mps == 0) {
      const double wait_s = rest_s(motion, body.coulomb_n, state.place_m);
      if (wait_s >= left_s) return state;
      motion = motion.from(wait_s);
      left_s -= wait_s;
    }
    const double sign = state.speed_mps != 0 ? std::copysign(1, state.speed_mps)
                                             : sign_from_rest(motion, body.coulomb_n, state.place_m);
    LinearMotion sliding = motion;
    sliding.force_n -= sign * body.coulomb_n;
    const double slide_s = time_of_stop_s(sliding, state, sign, left_s);
    const bool stops = slide_s < left_s;
    state = sliding.after(state, slide_s);
    if (stops) state.speed_mps = 0;
    motion = motion.from(slide_s);
    left_s -= slide_s;
  }
  return state;
}

}  // namespace tacto::firmware_host

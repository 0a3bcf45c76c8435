// SPDX-License-Identifier: GPL-3.0-or-later
// The motion of a mass on a spring and a damper under a force that changes linearly with time, to rounding.
#pragma once

namespace tacto::firmware_host {

struct PlaceAndSpeed {
  double place_m = 0;
  double speed_mps = 0;
};

/// m x'' + b x' + k x = force_n + force_rate_n_per_s t. Damping and stiffness may be 0.
struct LinearMotion {
  double mass_kg = 1;
  double damping_n_s_per_m = 0;
  double stiffness_n_per_m = 0;
  double force_n = 0;
  double force_rate_n_per_s = 0;

  /// The force on the mass at rest, without its inertia, at a time and a place.
  double driving_force_n(double time_s, double place_m) const {
    return force_n + force_rate_n_per_s * time_s - stiffness_n_per_m * place_m;
  }
  /// Place and speed after `time_s` from the state at time 0: the power series of the solution, in pieces of
  /// at most longest_piece_s(), in which it converges to rounding. Precondition: mass_kg above 0, time_s not
  /// negative.
  PlaceAndSpeed after(PlaceAndSpeed start, double time_s) const;

  double acceleration_mps2(PlaceAndSpeed state, double time_s) const {
    return (driving_force_n(time_s, state.place_m) - damping_n_s_per_m * state.speed_mps) / mass_kg;
  }

  /// In a piece of this length the acceleration has at most one zero, because the two roots of the motion are
  /// smaller than its inverse. Infinity for a free mass.
  double longest_piece_s() const;

  /// The same motion with its time counted from `time_s` on.
  LinearMotion from(double time_s) const;
};

/// The first time in (0, `duration_s`] at which the speed changes its sign, or `duration_s` where it does
/// not. `sign` is that of the motion just after time 0 (1 or -1; a start from rest has one, too).
double time_of_stop_s(const LinearMotion& motion, PlaceAndSpeed start, double sign, double duration_s);

}  // namespace tacto::firmware_host

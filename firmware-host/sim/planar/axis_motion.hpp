// SPDX-License-Identifier: GPL-3.0-or-later
// One axis of an emulated force device with a hand on it: between ticks the motion under a held force is
// solved exactly, and the stops and starts that Coulomb friction makes are found as events.
#pragma once

#include "firmware-host/sim/planar/linear_motion.hpp"

namespace tacto::firmware_host {

/// An axis, its friction against the ground, and a hand that holds it: mass, and spring and damper between
/// the axis and the place where the hand would rest.
struct AxisBody {
  double mass_kg = 0.1;               ///< of the axis and the hand together
  double viscous_n_s_per_m = 0;       ///< against the ground
  double coulomb_n = 0;               ///< against the ground, at rest and in motion
  double hand_damping_n_s_per_m = 0;  ///< against the hand's place
  double hand_stiffness_n_per_m = 0;  ///< against the hand's place
};

/// The hand's place moves evenly during a tick.
struct HandPlace {
  double place_m = 0;
  double speed_mps = 0;
};

/// State after `duration_s` under a constant force of the device's motor. Exact to rounding, whatever the
/// duration. The axis rests while the driving force is within Coulomb friction. Preconditions: mass_kg above
/// 0, all else finite and not negative where it is a property of the body.
PlaceAndSpeed moved(const AxisBody& body, PlaceAndSpeed start, double motor_force_n, HandPlace hand,
                    double duration_s);

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// Dry friction with stick and slip: the LuGre model (Canudas de Wit, Olsson, Astrom, Lischinsky 1995).
#pragma once

#include <cmath>

#include "firmware-host/sim/physics/finger_parameters.hpp"

namespace tacto::firmware_host {

struct LugreFriction {
  double coefficient = 0;       ///< tangential force over load, along the slip
  double bristle_rate_mps = 0;  ///< d(bristle)/dt
};

/// Friction at a slip speed with a bristle deflection of `bristle_m`. Equations (1) to (3) of the paper,
/// normalised by the load: dz/dt = v - s0 |v| z / g(v), mu = s0 z + s1 dz/dt. In the paper the static excess
/// in g decreases with exp(-(v/v_s)^2); here with 1 / (1 + (v/v_s)^2), which has the same bits on every
/// machine.
inline LugreFriction lugre_friction(const FingerParameters& finger, double bristle_m, double slip_mps) {
  const double ratio = slip_mps / finger.stribeck_mps;
  const double limit = finger.friction * (1 + (finger.static_ratio - 1) / (1 + ratio * ratio));
  const double rate = slip_mps - finger.bristle_stiffness_per_m * std::abs(slip_mps) * bristle_m / limit;
  return {finger.bristle_stiffness_per_m * bristle_m + finger.bristle_damping_s_per_m * rate, rate};
}

}  // namespace tacto::firmware_host

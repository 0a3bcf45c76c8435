// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a device is stable with virtual springs, dampers and bodies: eigenvalues of the sampled loop.
#pragma once

#include <vector>

#include "playback/stability/sampled_spring.hpp"

namespace tacto::playback {

/// A virtual mass that a virtual spring and damper couple to the hand (core/scene/body.hpp).
struct CoupledBody {
  double mass_kg = 0;
  double own_damping_n_s_per_m = 0;  ///< of its motion in the patch
  double stiffness_n_per_m = 0, damping_n_s_per_m = 0;
  bool may_rest = false;  ///< static friction holds it against small forces
  /// Moves as core::push_slide() instead: s <- (s + F T / m) / (1 + c T / m), p <- p + T s.
  bool semi_implicit = false;
};

/// What a device computes once a tick, along one axis.
struct SampledLoad {
  double stiffness_n_per_m = 0, damping_n_s_per_m = 0;
  std::vector<CoupledBody> bodies = {};
  double integral_n_per_m_s = 0;   ///< of the place, in a force that is added from the same tick on
  double integral_leak_per_s = 0;  ///< share of that force which is lost per second
};

/// Whether all eigenvalues of the loop over a tick T are inside of the unit circle. Place x and speed v of
/// `held` follow the exact discretisation of sampled_spring.hpp. A body i with place p, speed s, mass m and
/// the damping c of its own moves exactly under the force that is held for a tick (with z = c T / m):
///     F_i = K_i (x - p) + B_i ((x - x of the last tick) / T - s),    F = -K x - B (...) - sum of F_i
///     s <- e^-z s + (1 - e^-z) / c F_i,    p <- p + m (1 - e^-z) / c s + (z - 1 + e^-z) m / c^2 F_i
/// The force of the integral is J <- (1 - leak T) J + integral T x, and F has -J. The state is x, v, the last
/// step of x, J, x - p and s of each body, and the forces that are delayed; the
/// common place of hand and bodies is left out where no spring to the ground depends on it. A body that may
/// rest has to be stable both free and at rest, where its coupling is a spring and damper to the ground, in
/// each combination; its friction in motion is left out, as that of the device is.
/// Decided by the powers A^2, A^4, ... of the state's matrix: stable if the norm of one is below 1, unstable
/// if the trace of one is above the number of states. What 2^45 ticks do not decide counts as unstable: a
/// largest eigenvalue that is nearer to 1 than 1e-12. Time: with the third power of the delay in ticks, twice
/// for each body that may rest. Preconditions: as stiffness_limit(); masses above 0.
bool is_stable(const HeldMass& held, const TickTiming& timing, const SampledLoad& load);

/// By how much a motion of that loop grows per tick, its bodies free: the largest absolute eigenvalue, by the
/// norm of a power; above 1 it is unstable. Relative error below 1e-9. Preconditions: as is_stable().
double growth_per_tick(const HeldMass& held, const TickTiming& timing, const SampledLoad& load);

}  // namespace tacto::playback

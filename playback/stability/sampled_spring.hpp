// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stiffness at which a spring that a device computes once a tick is stable.
#pragma once

namespace tacto::playback {

/// What moves, in continuous time: mass x'' + damping x' + stiffness x = force. The hand that holds a device
/// adds to all three.
struct HeldMass {
  double mass_kg = 0;
  double damping_n_s_per_m = 0;
  double stiffness_n_per_m = 0;
};

/// A force is held from `delay_ticks` after its tick until that of the next tick takes its place.
struct TickTiming {
  double period_s = 0;
  double delay_ticks = 0;  ///< fractions of a tick included
};

/// The K up to which every spring f = -K x - B (x - x of the last tick) / T, computed once a tick, is stable
/// on `held`; 0 if not even a small K is, infinity if each K is. B is `virtual_damping_n_s_per_m`.
///
/// Computed from the exact discretisation (Franklin, Powell, Workman 1998, section 4.3; the delay's part of a
/// tick: Astrom, Wittenmark 1997, section 3.2). With G(t) the place and G'(t) the speed after a force of 1 N
/// for the time t, the state after a tick T is
///     x <- (1 - k G) x + m G' v + ...,    v <- -k G' x + (1 - b G' - k G) v + ...
/// and with a delay of n + f ticks the characteristic polynomial, of degree n + 4, is affine in K:
///     D(z) z^(n+2) + (K z + B (z - 1) / T) N(z)
///     D(z) = w^2 + (b G' + 2 k G) w + k (G (b G' + k G) + m G'^2),    w = z - 1
///     N(z) = (w + b G' + k G) (z g1 + g0) + m G' (z h1 + h0)
/// where g1, h1 are place and speed after 1 N for (1 - f) T, and g0 = G - g1, h0 = G' - h1. An eigenvalue
/// leaves the unit circle at e^(i theta) where the K that solves the equation is real: all such theta are
/// found, and the least positive K is the limit. Relative error below 1e-9.
/// Preconditions: mass and period above 0, all else finite and not negative.
double stiffness_limit(const HeldMass& held, const TickTiming& timing, double virtual_damping_n_s_per_m);

}  // namespace tacto::playback

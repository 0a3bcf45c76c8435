// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stiffness with which a device is stable while no hand holds it.
#pragma once

namespace tacto::playback {

/// The K up to which each spring f = -K x, computed once a tick T and held, is stable on a mass M with the
/// damping B. Without delay in closed form, from the exact discretisation (Minsky 1990 states T < C B / K):
///     e = exp(-B T / M), a = B / M, p = (T / a - (1 - e) / a^2) / M, q = (1 - e)^2 / (a^2 M) - p e
///     K < min((1 - e) / q, 2 (1 + e) / (p - q) where p > q)
/// and K T / B = 2 for small B T / M. With a delay by the eigenvalues (sampled_spring.hpp): about
/// B / (T (1/2 + delay)) for small B T / M (Hulin 2006). 0 without damping. Relative error below 1e-9.
/// Preconditions: mass and period above 0, damping and delay finite and not negative. Not for the tick.
double free_stiffness_limit(double mass_kg, double damping_n_s_per_m, double period_s, double delay_ticks);

}  // namespace tacto::playback

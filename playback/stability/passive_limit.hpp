// SPDX-License-Identifier: GPL-3.0-or-later
// The stiffness up to which a virtual spring and damper are passive: no passive hand makes them unstable.
#pragma once

#include <limits>

#include "data-schema/device/device.hpp"
#include "playback/stability/sampled_spring.hpp"

namespace tacto::playback {

/// The K up to which the axis's own friction dissipates at least the energy that a sampled spring K and
/// damper B give, whatever the motion of a hand that is slower than `speed_mps`; 0 if friction is less than B
/// alone requires. With viscous friction b, Coulomb friction c, encoder step D and period T:
///     K <= min(2 c' / D, ((b - B) v + c') / (L T v + D / 2)),    c' = c - B D / T
/// - Any speed, without encoder: b >= L K T + B. Without delay L = 1/2: b > K T / 2 + B is the integral
///   condition of Colgate and Schenkel (1997, equation 14), (T / 2) Re{(1 - z^-1) H(z)} / (1 - cos w T) < b
///   for all z = e^(i w T), w <= pi / T, of H = K + B (1 - z^-1) / T.
/// - Any speed: K <= min(2 b / T, 2 c / D) for B = 0 (Abbott and Okamura 2005, equation 18).
/// - Speed below v: in a tick with the path s <= v T the hold gives at most K s^2 / 2, the encoder's rounding
///   K D s / 2, the damper B s^2 / T and its rounding B D s / T; friction dissipates b s^2 / T + c s.
/// - Delay of n + f ticks: L is the largest eigenvalue of the energy of the held spring,
///     L = (d + 1/2 + sqrt((d + 1/2)^2 + f (1 - f))) / 2,    d = n + f,
///   which a motion of one period T attains; L = d + 1/2 for whole ticks, as the integral condition has it.
///   With both delay and B it is sufficient, and the integral condition permits a little more.
/// Proved for a velocity that is the difference of two ticks. Not for the tick.
double passive_stiffness_limit(const schema::DeviceAxis& axis, const TickTiming& timing,
                               double virtual_damping_n_s_per_m,
                               double speed_mps = std::numeric_limits<double>::infinity());

/// The viscous friction of axis and finger with which K and B are passive at any speed, without an encoder's
/// rounding: b = L K T + B.
double passive_damping_needed(const TickTiming& timing, double stiffness_n_per_m,
                              double virtual_damping_n_s_per_m);

/// The speed v up to which passive_stiffness_limit(..., v) >= K: 0 if there is none, infinity if each is.
double largest_passive_speed_mps(const schema::DeviceAxis& axis, const TickTiming& timing,
                                 double stiffness_n_per_m, double virtual_damping_n_s_per_m);

/// The amplitude below which Coulomb friction stops the growing oscillation of the free axis:
///     A = 4 c / (pi w (K T (1/2 + d) - b - B)),    w = sqrt(K / M)
/// (describing function of Coulomb friction, 4 c / (pi w A)), for w T <= 0.2; infinity if it does not grow,
/// NaN for larger w T.
double friction_basin_m(const schema::DeviceAxis& axis, const TickTiming& timing, double stiffness_n_per_m,
                        double virtual_damping_n_s_per_m);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// The transient of a contact: its force over time, its table for the kernel, and what the limits of a device
// cut of it.
#pragma once

#include <optional>
#include <string>

#include "data-schema/device/device.hpp"
#include "data-schema/scene/piece.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::playback {

/// Warnings are about taps up to this speed; ours, a fast tap with a stylus.
inline constexpr double kFastTap_mps = 0.5;

/// A force per speed of the contact, s'' + 2 decay s' + square s = 0 from the contact on, damped in any way.
struct Transient {
  double start_n_s_per_m = 0, rise_n_per_m = 0;  ///< s and s' at the contact
  double decay_per_s = 0, square_per_s2 = 0;
};

/// Of a decaying sine: start 0, rise beta w, square a^2 + w^2. Of a hand and a surface, for the hand's mass m
/// on its spring k and damper b, which is driven at the speed of the contact, and the surface's k_s and b_s:
/// model (12) of Fiene and Kuchenbecker 2007 by partial fractions, without its slow part (slow_surface()).
std::optional<Transient> transient_of(const schema::Piece& piece);

/// What the force of a hand and surface is after the transient: stiffness x way + damping x speed. A wall
/// with this stiffness and damping, and the transient of amplitude 1, give together the force of the model.
struct SlowSurface {
  double stiffness_n_per_m = 0;  ///< k k_s / (k + k_s)
  double damping_n_s_per_m = 0;  ///< (k^2 b_s + k_s^2 b) / (k + k_s)^2
};
SlowSurface slow_surface(const schema::HandSurface& model);

/// Its force per speed at a time after the contact, N s/m. One form for every damping: e^(-a t) sin(w t) / w
/// and its limit, or the hyperbolic sine from the two decays.
double force_at(const Transient& transient, double time_s);

/// The table of the piece's transient, or of none. Errors: unsuitable: a frequency of half the rate or more,
/// or a decay of less than 1 /s. `where` is its piece.
schema::Result<core::TransientTable> transient_table(const schema::Piece& piece, double rate_hz,
                                                     const std::string& where);

/// The largest force per speed of the contact; of a decaying sine formula (4) of Fiene and Kuchenbecker 2007
/// without its mass: beta w / sqrt(a^2 + w^2) e^(-(a / w) atan(w / a)). Sampled every T it is lower by at
/// most 1.6 (a^2 + w^2) T^2 / 8 of itself.
double transient_peak_n_s_per_m(const Transient& transient);

/// The mass whose momentum the transient takes, the integral of its force per speed; of a decaying sine beta
/// w / (a^2 + w^2), from (3).
double transient_stops_kg(const Transient& transient);

/// Up to this speed v of a contact no limit of the device cuts the transient s of this piece with the spring,
/// damper and integral of its wall, at the upper ends of their sliders, on a hand that goes on at v. At the
/// ticks t = 0, T, ... until e^2 = s^2 + s'^2 / square is below that of half the peak:
///     v (|s(t)| + B + K d + I d (d + T) / 2) <= the peak force of each axis and of the vector, d = t + T
///     v (max((|s(0)| + B) / T, sqrt(s'(0)^2 + square s(0)^2)) + K + I d) <= the slew
/// A hand that is slowed meets less; other pieces are left out. Infinity without a transient. Precondition:
/// transient_table() is no error.
double transient_whole_to_mps(const schema::Piece& piece, const schema::Device& device, double rate_hz);

}  // namespace tacto::playback

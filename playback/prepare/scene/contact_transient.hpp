// SPDX-License-Identifier: GPL-3.0-or-later
// The transient of a contact: its table for the kernel, its peak, and what the limits of a device cut of it.
#pragma once

#include <optional>
#include <string>

#include "data-schema/device/device.hpp"
#include "data-schema/scene/piece.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::playback {

/// Warnings are about taps up to this speed; ours, a fast tap with a stylus.
inline constexpr double kFastTap_mps = 0.5;

/// The table of the transient, or of none. Errors: unsuitable: a frequency of half the rate or more. `where`
/// is its piece.
schema::Result<core::TransientTable> transient_table(const std::optional<schema::ContactTransient>& transient,
                                                     double rate_hz, const std::string& where);

/// The largest force per speed of the contact, formula (4) of Fiene and Kuchenbecker 2007 without its mass:
/// beta w / sqrt(a^2 + w^2) e^(-(a / w) atan(w / a)). Sampled every T it is lower by at most 1.6 (a^2 + w^2)
/// T^2 / 8 of itself.
double transient_peak_n_s_per_m(const schema::ContactTransient& transient);

/// The mass whose momentum the transient takes: beta w / (a^2 + w^2), from (3).
double transient_stops_kg(const schema::ContactTransient& transient);

/// Up to this speed of a contact no limit of the device cuts the transient by itself: its peak the peak force
/// of each axis and of the vector, its steepest rise, beta w v, the slew.
double transient_whole_to_mps(const schema::ContactTransient& transient, const schema::Device& device);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stiffness that an axis of a device displays to one known hand without becoming unstable.
#pragma once

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "playback/stability/sampled_spring.hpp"

namespace tacto::playback {

/// The hand's mass, spring and damper and the axis's mass and viscous friction act at all times; only the
/// virtual spring and damper are sampled (Hulin, Preusche, Hirzinger 2006; formula: sampled_spring.hpp).
/// Coulomb friction is left out. N/m, as stiffness_limit().
double hand_stiffness_limit(const schema::DeviceAxis& axis, const schema::Hand& hand,
                            const TickTiming& timing, double virtual_damping_n_s_per_m);

/// Minsky 1990, after equation (7): the hand's stiffness is a part of the sampled spring, and all damping
/// acts at all times: K + K_hand < free_stiffness_limit(m + m_hand, b + b_hand + B). N/m, at least 0.
double lumped_stiffness_limit(const schema::DeviceAxis& axis, const schema::Hand& hand,
                              const TickTiming& timing, double virtual_damping_n_s_per_m);

}  // namespace tacto::playback

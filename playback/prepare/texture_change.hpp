// SPDX-License-Identifier: GPL-3.0-or-later
// Whether another texture may take the place of one that plays.
#pragma once

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// A change keeps rate, filter, following, limits, energy and contact: they belong to the transducer and the
/// rate. Both textures lie in the device's memory of `profile_samples` until the fade is over. Errors:
/// unsuitable, with what differs, or how much room there is; the remedy is to disarm first.
schema::Result<void> check_texture_change(const Prepared& playing, const Prepared& next,
                                          std::uint32_t profile_samples);

}  // namespace tacto::playback

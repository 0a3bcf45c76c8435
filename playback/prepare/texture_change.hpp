// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether another texture may replace the one that plays.
#pragma once

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// A change keeps rate, filter, tracking, limits, energy and contact, because they belong to the transducer
/// and the rate. Both textures are in the device's memory of `profile_samples` until the fade is over.
/// Errors: unsuitable, with the difference, or how much memory there is; the remedy is to disarm first.
schema::Result<void> check_texture_change(const Prepared& playing, const Prepared& next,
                                          std::uint32_t profile_samples);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// Which textures a session's drive was of in each row, and how much of each.
#pragma once

#include <vector>

#include "playback/daemon/session_columns.hpp"

namespace tacto::playback {

/// A set of textures in consecutive rows: parts of the whole, 0 to 1, all sets' together 1.
struct MixedSet {
  std::size_t first = 0;
  std::vector<float> part;
};

/// Set 0 is the header's, set n what the n-th change brought.
struct TextureMix {
  std::vector<MixedSet> sets;
  std::vector<bool> unknown;  ///< a row: what is not known had a part in it
};

/// As core::TexturePlayer fades: w = u^2 (3 - 2 u), a second change beginning from what is nearer; a row that
/// was filled in (evened()) is no tick. In the place of a set that is not `known` the last known one goes on:
/// its rows are unknown, those beside them do not end in a step. Precondition: known.size() = turns + 1.
TextureMix texture_mix(const SessionColumns& columns, const std::vector<bool>& known);

/// The factor on the textures' gains as the kernel follows it: evenly to a new one, within 10 ms.
std::vector<double> followed_gain(const SessionColumns& columns);

}  // namespace tacto::playback

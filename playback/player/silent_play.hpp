// SPDX-License-Identifier: GPL-3.0-or-later
// The reason why a playback had no drive, at all or for a part of the time.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "playback/player/program.hpp"
#include "playback/session/tick_view.hpp"

namespace tacto::playback {

/// Where and under which conditions a program has a drive.
struct PlayableRange {
  double start_m = 0, end_m = 0;
  bool stops = true;          ///< no drive beyond its ends
  double contact_on_n = 0;    ///< 0: no contact gate
  double reach_m = INFINITY;  ///< from the encoder's zero
};

PlayableRange playable_range(const Program& program);

/// A sentence if ticks were played and all had a drive of zero: because of the gate, of the finger's path, or
/// for another reason; none if there was a drive.
std::optional<std::string> note_of_silence(const TickView& ticks, const PlayableRange& what);

/// A share of the time above which the finger was off the textures for too long.
inline constexpr double kMostOffTextures = 0.1;

/// A sentence with the share, the places, and what to do, if `share` is above kMostOffTextures; positions in
/// m.
std::optional<std::string> note_off_textures(double share, double finger_from_m, double finger_to_m,
                                             const PlayableRange& what);
std::optional<std::string> note_off_textures(const TickView& ticks, const PlayableRange& what);

}  // namespace tacto::playback

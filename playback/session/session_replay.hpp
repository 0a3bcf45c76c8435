// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a session again, on the firmware's own core, and compares drive with drive.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "data-schema/session/session_reader.hpp"

namespace tacto::playback {

/// Where the replayed drive first differs from the recorded one.
struct Difference {
  std::uint64_t tick = 0;
  float recorded_v = 0, replayed_v = 0;
};

struct ReplayOutcome {
  std::uint64_t ticks = 0;  ///< compared
  std::optional<Difference> first_difference;
  /// Ticks that are missing in the session: what comes after them can't be replayed, for the filters' past is
  /// not known.
  std::optional<std::uint64_t> lost_at;
  std::uint64_t lost = 0;  ///< ticks that are missing, by the session's own words
  schema::SessionEnding ending = schema::SessionEnding::unread;
  /// The byte from which on the file is damaged: what comes after it was not read.
  std::optional<std::uint64_t> damaged_at;

  /// All of it is there, and the same.
  bool same() const { return !first_difference && !lost_at && !damaged_at; }
};

/// Hears of each tick that was replayed alike what the kernel wished before amplitude, slew and energy were
/// held, V.
using WishListener = std::function<void(const schema::SessionTick& tick, float unlimited_v)>;

/// The recorded commands go to a device of this program's core in the ticks that took them, the recorded
/// counts to its encoder (a texture that it changes to, in the tick of the change); its drive has to be the
/// recorded one to the bit. A fault is met again where its
/// cause is in the ticks (enable input, jump, no number) or in the silence of the host. Of a contact gate the
/// ticks tell what it decided, not the force. Nothing but the session is read. Errors: unsuitable, where
/// there are no ticks, where a part of what is sent up to arming is not in it, or where a contact gated a
/// session whose ticks do not tell (before protocol 1.2); malformed, where a command in it is no frame;
/// unsuitable, where the core refuses one, with its reason. `progress` hears fractions; `wishes` costs the
/// same again: a second device, without limits, is given the same. It comes to rest a little sooner where the
/// slew held the other one, at most drive limit / slew limit, and then takes a count that was unseen so much
/// sooner.
schema::Result<ReplayOutcome> replay_session(const std::string& name,
                                             const std::function<void(double)>& progress = {},
                                             const WishListener& wishes = {});

}  // namespace tacto::playback

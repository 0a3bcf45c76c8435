// SPDX-License-Identifier: GPL-3.0-or-later
// Replays a session on the firmware's own core, and compares the drives.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "data-schema/session/session_reader.hpp"

namespace tacto::core {
class SceneKernel;
}

namespace tacto::playback {

/// Where the replayed drive, or force of an axis, first differs from the recorded one.
struct Difference {
  std::uint64_t tick = 0;
  float recorded = 0, replayed = 0;
  std::string unit;  ///< "v" or "n"
};

struct ReplayOutcome {
  std::uint64_t ticks = 0;  ///< compared
  std::optional<Difference> first_difference;
  /// The first tick that is missing in the session: what follows cannot be replayed, because the state of the
  /// filters is unknown.
  std::optional<std::uint64_t> lost_at;
  std::uint64_t lost = 0;  ///< missing ticks, as the session states
  schema::SessionEnding ending = schema::SessionEnding::unread;
  /// Offset of the first damaged byte; nothing is read from there on.
  std::optional<std::uint64_t> damaged_at;

  /// Whether the session is complete and the drives are equal.
  bool same() const { return !first_difference && !lost_at && !damaged_at; }
};

/// Receives, for each tick that was replayed with the same drive, the kernel's drive before the limits of
/// amplitude, slew and energy, V.
using UnlimitedListener = std::function<void(const schema::SessionTick& tick, float unlimited_v)>;

/// Receives the kernel of a scene after each tick in which the replayed forces were the recorded ones.
using SceneListener = std::function<void(const core::SceneKernel& scene)>;

/// A device with this program's core receives the recorded commands at the ticks that received them, and the
/// recorded counts as its encoder (the upload of a change of texture, in the tick of the change). Its drive
/// has to equal the recorded one to the bit. A fault is reproduced if its cause is in the ticks (enable
/// input, jump, not a number) or is the host's silence. For a contact gate the ticks contain its decision,
/// not the force. Only the session is read. Errors: unsuitable, if there are no ticks, if a part of what is
/// sent up to arming is missing; malformed, if a command in it is not a frame; unsuitable, if the core
/// refuses one, with its reason. `progress` receives fractions; `listener` doubles the cost, because a second
/// device, without limits, is replayed too. `at_end` receives
/// the kernel of a scene after the last tick, if all were the same. This one comes to rest a little earlier
/// if the slew limit delayed the other, by at most drive limit / slew limit, and then accepts a count that
/// was unseen that much earlier.
schema::Result<ReplayOutcome> replay_session(const std::string& name,
                                             const std::function<void(double)>& progress = {},
                                             const UnlimitedListener& listener = {},
                                             const SceneListener& scene_listener = {},
                                             const SceneListener& at_end = {});

}  // namespace tacto::playback

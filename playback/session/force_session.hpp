// SPDX-License-Identifier: GPL-3.0-or-later
// A session of forces: figures of its axes, and its ticks as a table.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/files/files.hpp"
#include "data-schema/session/session_reader.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

struct ForceSessionAxis {
  std::string name;
  double from_m = 0, to_m = 0;  ///< the range of its places
  double force_rms_n = 0, force_peak_n = 0;
};

struct ForceSession {
  std::vector<ForceSessionAxis> axes;
  std::uint64_t ticks = 0, lost = 0;
  LimitCounts limits;
  bool damaged = false;
};

/// Receives each tick, with its time since the first one.
using ForceTickSink = std::function<void(const schema::SessionTick& tick, double time_s)>;

/// Precondition: the session's header has forces. Errors: as SessionReader::open; no_ticks_in.
schema::Result<ForceSession> read_force_session(const std::string& name, const ForceTickSink& sink = {});

/// The ticks as CSV: tick, time_s, NAME_m and force_NAME_n of each axis, playing, fault, late, limited (a
/// peak or the slew), rms_limited, and of each piece that slides slide_NAME_m, its place along its direction
/// after the tick: computed again (replay_session()), so it is empty from the first tick on that cannot be.
/// Returns a note of that, or an empty string. Errors: as read_force_session; cannot_write; usage.
schema::Result<std::string> export_force_session(const std::string& name, const std::string& file,
                                                 schema::Existing existing);

}  // namespace tacto::playback

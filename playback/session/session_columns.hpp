// SPDX-License-Identifier: GPL-3.0-or-later
// The ticks of a session in memory, as columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

/// One row per tick; all columns have the same length.
struct SessionColumns {
  schema::SessionHeader header;
  std::vector<std::uint64_t> tick;
  std::vector<double> position_m;  ///< as SessionRow::position_m
  std::vector<double> drive_v;
  std::optional<std::uint64_t> lost_at;  ///< the first tick that is missing
  std::uint64_t lost = 0;                ///< includes those after the last tick
};

/// A whole session. Errors: as session_overview; unsuitable: more than 2^24 ticks (28 min at 10 kHz; memory).
schema::Result<SessionColumns> read_session_columns(const std::string& name);

}  // namespace tacto::playback

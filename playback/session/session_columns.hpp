// SPDX-License-Identifier: GPL-3.0-or-later
// Ticks of a session in memory, column by column.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

/// A row a tick, all columns of one length.
struct SessionColumns {
  schema::SessionHeader header;
  std::vector<std::uint64_t> tick;
  std::vector<double> position_m;  ///< as SessionRow::position_m
  std::vector<double> drive_v;
  std::optional<std::uint64_t> lost_at;  ///< the first tick that is missing
  std::uint64_t lost = 0;                ///< also after the last one
};

/// A whole session. Errors: as session_overview; unsuitable: more than 2^24 ticks (28 min at 10 kHz; memory).
schema::Result<SessionColumns> read_session_columns(const std::string& name);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// Ticks of a session in memory, column by column.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "playback/daemon/session_rows.hpp"

namespace tacto::playback {

/// A row a tick, all columns of one length.
struct SessionColumns {
  schema::SessionHeader header;
  std::vector<std::uint64_t> tick;
  std::vector<double> time_s;      ///< since the first tick, by the device's clock
  std::vector<double> position_m;  ///< as SessionRow::position_m
  std::vector<double> drive_v;
  std::vector<double> gain;  ///< factor on the textures' own gains
  std::vector<std::uint32_t> flags;
  std::vector<std::int32_t> encoder;
  std::optional<std::uint64_t> lost_at;  ///< the first tick that is missing
  std::uint64_t lost = 0;                ///< also after the last one
  std::vector<TextureTurn> turns;        ///< in their order
  double look_ahead_ticks = 0;           ///< the drive is of where the finger will be then
};

/// A whole session. Errors: as session_overview; unsuitable: more than 2^24 ticks (28 min at 10 kHz; memory).
schema::Result<SessionColumns> read_session_columns(const std::string& name);

}  // namespace tacto::playback

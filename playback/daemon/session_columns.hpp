// SPDX-License-Identifier: GPL-3.0-or-later
// A whole session in memory, column by column.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/session_reader.hpp"

namespace tacto::playback {

/// A row a tick, all columns of one length.
struct SessionColumns {
  schema::SessionHeader header;
  std::vector<std::uint64_t> tick;
  std::vector<double> time_s;      ///< since the first tick, by the device's clock
  std::vector<double> position_m;  ///< the middle of the encoder's count
  std::vector<double> drive_v;
  std::vector<double> gain;  ///< factor on the textures' own gains
  std::vector<std::uint32_t> flags;
  std::vector<std::int32_t> encoder;
  std::optional<std::uint64_t> lost_at;  ///< the first tick that is missing
  std::uint64_t lost = 0;
  /// The first row that another texture than the header's is in.
  std::optional<std::size_t> changed_at;
};

/// Errors: as SessionReader::open; unsuitable: no ticks, or more than 2^24 (28 min at 10 kHz; memory).
schema::Result<SessionColumns> read_session_columns(const std::string& name);

}  // namespace tacto::playback

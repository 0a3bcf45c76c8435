// SPDX-License-Identifier: GPL-3.0-or-later
// A whole session in memory, column by column.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/session_reader.hpp"

namespace tacto::playback {

/// A change of texture.
struct TextureTurn {
  std::size_t row = 0;                           ///< the first that another texture is in
  double fade_ticks = 0;                         ///< over which it comes in (core::TexturePlayer)
  std::optional<schema::SessionProgram> brings;  ///< none: the session does not say, as older ones
};

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
  std::uint64_t lost = 0;                ///< also after the last one
  /// The byte from which on the file is damaged; what comes after it is not here.
  std::optional<std::uint64_t> damaged_at;
  bool closed = false;             ///< by its last block; else its writer is still at it, or was killed
  std::vector<TextureTurn> turns;  ///< in their order
  double look_ahead_ticks = 0;     ///< the drive is of where the finger will be then
};

/// The same with a row for each period, as a signal at one rate needs it. A computer that closes the loop may
/// stand still: then periods pass without a tick, as the ticks' times tell.
struct EvenColumns {
  SessionColumns columns;   ///< what was put in: place, drive and time on a line between the neighbours
  std::uint64_t added = 0;  ///< rows
  std::size_t stops = 0;    ///< stretches of over 10 ms; not playing in `flags`
};

/// Errors: unsuitable: more than 2^24 rows.
schema::Result<EvenColumns> evened(const SessionColumns& columns);

/// What to say of a session without a tick: unsuitable; malformed where it is damaged, from a byte on.
schema::Error no_ticks_in(const std::string& path, const std::optional<std::uint64_t>& damaged_at);

/// Errors: as SessionReader::open; no_ticks_in; unsuitable: more than 2^24 (28 min at 10 kHz; memory).
schema::Result<SessionColumns> read_session_columns(const std::string& name);

}  // namespace tacto::playback

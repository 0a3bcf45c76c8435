// SPDX-License-Identifier: GPL-3.0-or-later
// One stroke of a session, and what is predicted of it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

struct SessionStroke {
  SessionOverview overview;         ///< of the session that it is of
  std::vector<TextureTurn> turns;   ///< of the session
  std::uint64_t stroke = 0;         ///< 1-based
  std::uint64_t strokes = 0;        ///< of so many
  std::uint64_t first_row = 0;      ///< in the session
  std::vector<SessionRow> rows;     ///< of the stroke, one a period
  std::vector<double> predicted_m;  ///< in each (predicted_displacement_m, with 5 s around them)
};

/// `stroke` is 1-based; 0 takes the longest way. The session is read row by row; a stroke is held in memory.
/// Errors: as session_overview; usage: no such stroke; unsuitable: none of 5 mm, ticks missing, a stroke of
/// over 2^22 ticks (7 min at 10 kHz). `progress` hears fractions.
schema::Result<SessionStroke> read_session_stroke(const std::string& name, std::uint64_t stroke,
                                                  const std::function<void(double)>& progress = {});

}  // namespace tacto::playback

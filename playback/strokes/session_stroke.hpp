// SPDX-License-Identifier: GPL-3.0-or-later
// One stroke of a session, and its predicted displacement.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

struct SessionStroke {
  SessionOverview overview;          ///< of its session
  std::vector<TextureChange> turns;  ///< of the session
  std::uint64_t stroke = 0;          ///< 1-based
  std::uint64_t strokes = 0;         ///< number of strokes in the session
  std::uint64_t first_row = 0;       ///< in the session
  std::vector<SessionRow> rows;      ///< of the stroke, one per period
  std::vector<double> predicted_m;   ///< at each row (predicted_displacement_m, with 5 s around)
  std::vector<double> measured_m;    ///< the same by the tray's sensor; empty: none, or samples are missing
};

/// `stroke` is 1-based; 0 selects the longest stroke. The session is read row by row; one stroke is held in
/// memory. Errors: as session_overview; usage: no such stroke; unsuitable: no stroke of 5 mm, ticks missing,
/// a stroke of over 2^22 ticks (7 min at 10 kHz). `progress` receives fractions.
schema::Result<SessionStroke> read_session_stroke(const std::string& name, std::uint64_t stroke,
                                                  const std::function<void(double)>& progress = {});

}  // namespace tacto::playback

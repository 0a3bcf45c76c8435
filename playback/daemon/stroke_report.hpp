// SPDX-License-Identifier: GPL-3.0-or-later
// What the finger received in each stroke of a session, against what was wanted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/session_reader.hpp"
#include "playback/daemon/session_columns.hpp"
#include "playback/limit_tally.hpp"

namespace tacto::playback {

/// One way of the finger without turning, while playing.
struct PlayedStroke {
  double from_s = 0, to_s = 0;  ///< since the first tick
  double from_m = 0, to_m = 0;
  double wanted_rms_m = 0, received_rms_m = 0;
  double error_db = 0;  ///< RMS of received - wanted, re RMS of wanted; at most 0 where nothing was wanted
  double level_db = 0;  ///< received over wanted
  std::uint64_t limited_ticks = 0;                          ///< in amplitude or slew
  std::uint64_t energy_limited_ticks = 0, gated_ticks = 0;  ///< turned down; not touching
  std::optional<LimitTally> limits;                         ///< none: what they took is not known
};

struct StrokeReport {
  std::vector<PlayedStroke> strokes;
  std::optional<LimitTally> limits;  ///< of the whole session; none: what they took is not known
  double low_hz = 0, high_hz = 0;    ///< the band in which both are taken
  std::vector<std::string> notes;    ///< what could not be judged, and why
  bool damaged = false;              ///< the file: what comes after the damage is not in the report
};

/// Rows of a session that are one stroke, both included.
struct StrokeRange {
  std::size_t first = 0, last = 0;
};
std::vector<StrokeRange> stroke_ranges(const SessionColumns& columns);

/// What the model makes of the recorded drive, in the session's band: displacement in m, one a row.
std::vector<double> received_displacement_m(const SessionColumns& columns);

/// Wanted: as wanted_in(), the gain of the commands and changes of texture in it. Periods without a tick
/// (evened()) are filled in. Received: the recorded drive, held between ticks, through the transducer's
/// model: what the actuator would do without a finger on it, hysteresis or a second mode. The delay that the
/// session was prepared with and did not look ahead by is part of the error. A stroke is at least 5 mm long.
/// What the limits took: hear_wishes(), a note where it is not known.
/// Errors: as SessionReader::open; unsuitable: no ticks, or over 30 minutes of them (memory). A texture that
/// is gone or is another one by now, and a change that the session does not name (an older one), leave the
/// wanted side of the strokes that they have a part in out, with a note.
schema::Result<StrokeReport> report_strokes(const std::string& name);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// What the finger received in each stroke of a session, against what was wanted.
#pragma once

#include <string>
#include <vector>

#include "data-schema/session_reader.hpp"
#include "playback/daemon/session_columns.hpp"

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
};

struct StrokeReport {
  std::vector<PlayedStroke> strokes;
  double low_hz = 0, high_hz = 0;  ///< the band in which both are taken
  std::vector<std::string> notes;  ///< what could not be judged, and why
  bool damaged = false;            ///< the file: what comes after the damage is not in the report
};

/// Rows of a session that are one stroke, both included.
struct StrokeRange {
  std::size_t first = 0, last = 0;
};
std::vector<StrokeRange> stroke_ranges(const SessionColumns& columns);

/// What the model makes of the recorded drive, in the session's band: displacement in m, one a row.
std::vector<double> received_displacement_m(const SessionColumns& columns);

/// Wanted: gain x texture along the path between the recorded counts (monotone cubics through the places
/// where the count changed, half a count and half a tick off at most), through the exact reference
/// (reference/wanted.hpp), with the gain of the commands. Periods without a tick (evened()) are filled in.
/// Received: the recorded drive, held between ticks, through the transducer's model: what the actuator would
/// do without a finger on it, hysteresis or a second mode. The delay that the session was prepared with and
/// did not look ahead by is part of the error. A stroke is at least 5 mm long. Errors: as
/// SessionReader::open; unsuitable: no ticks, or over 30 minutes of them (memory); a texture that is gone or
/// is another one by now leaves the wanted side out, with a note; so does a change of texture, of the strokes
/// that reach beyond it.
schema::Result<StrokeReport> report_strokes(const std::string& name);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// What each stroke of a session made of the tray, by the model and by its sensor, against what was wanted.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// Of a displacement in a stroke's rows.
struct StrokeDisplacement {
  double rms_m = 0;
  double error_db = 0;  ///< RMS of it - wanted, re RMS of wanted
  double level_db = 0;  ///< over wanted
};

/// What the tray's sensor measured: its error is the least within 1 ms of shift in time either way, one shift
/// a stroke, for an instrument may be late.
struct MeasuredDisplacement : StrokeDisplacement {
  double shift_s = 0;  ///< of the measured displacement behind the wanted one; taken out of the error
};

/// One way of the finger without turning, while playing.
struct PlayedStroke {
  double from_s = 0, to_s = 0;  ///< since the first tick
  double from_m = 0, to_m = 0;
  double target_rms_m = 0;                       ///< 0 where it is not known, or under 1 pm
  StrokeDisplacement predicted;                  ///< error and level: where wanted is known
  std::optional<MeasuredDisplacement> measured;  ///< none: no sensor, or its samples are not all there
  std::uint64_t limited_ticks = 0;               ///< in amplitude or slew
  std::uint64_t energy_limited_ticks = 0, gated_ticks = 0;  ///< turned down; not touching
  std::optional<LimitTally> limits;                         ///< none: what they took is not known
};

struct StrokeReport {
  std::vector<PlayedStroke> strokes;  ///< the first kMostStrokesKept
  std::uint64_t stroke_count = 0;     ///< of all
  std::optional<LimitTally> limits;   ///< of the whole session; none: what they took is not known
  double low_hz = 0, high_hz = 0;     ///< the band in which both are taken
  std::vector<std::string> notes;     ///< what could not be judged, and why
  bool damaged = false;               ///< the file: what comes after the damage is not in the report
};

/// An hour at three strokes a second.
inline constexpr std::size_t kMostStrokesKept = 10000;

/// How much of a session is judged at once, with so much of what is around it: what the band's filters take
/// from farther away is left out. Their edges are raised cosines of 3 and 5 Hz, whose responses fall with the
/// third power of time: over 5 s away is at most 5e-4 of the largest value there, if all of it is at an edge.
struct JudgedBlocks {
  double block_s = 20, around_s = 5;
};

struct StrokeListener {
  std::function<void(const PlayedStroke&)> stroke;  ///< each one, in their order, also beyond those kept
  std::function<void(double)> progress;             ///< 0 to 1
};

/// Wanted: as WantedReader, the gain of the commands and changes of texture in it. Periods without a tick
/// are put in, of one stop at most so many that nothing before it reaches beyond. Predicted: the recorded
/// drive through the model in the transducer's file (with the hysteresis that the file has): what the
/// actuator would do if that file was right, without a finger on it. The delay that the session was prepared
/// with and did not look ahead by is part of its error. Measured, where the device reports its tray: the
/// session's samples (measured_rows.hpp). All in the same band. A stroke is at least 5 mm long.
/// What the limits took: hear_every_wish(), a note where it is not known.
/// Memory does not grow with the session, nor with a stroke: that of a block (JudgedBlocks; 200,000 rows at
/// 10 kHz) and its textures, of the strokes kept, and of the commands. The reading of a block stays under
/// 2^24 points.
/// Errors: as session_overview. A texture that is gone or is another one by now, and a change that the
/// session does not name (an older one), leave the wanted side of the strokes that they have a part in out,
/// with a note. Of a session with ticks missing the strokes that end before the first of them are judged, as
/// if the drive ended there, with a note; what the limits took in them is not told. Blind ticks are in no
/// stroke, with a note.
schema::Result<StrokeReport> report_strokes(const std::string& name, const StrokeListener& listener = {},
                                            const JudgedBlocks& blocks = {});

}  // namespace tacto::playback

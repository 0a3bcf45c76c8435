// SPDX-License-Identifier: GPL-3.0-or-later
// For each stroke of a session: the tray's displacement by the model and by its sensor, compared with the
// target.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// A displacement over a stroke's rows: that of the model, or that of the tray's sensor. Its error is the
/// smallest for a constant shift in time within 1 ms either way, one shift per stroke, because an instrument
/// may have a delay. If it is smallest at an end of that range, the shift is not found, and the error is that
/// without a shift.
struct StrokeDisplacement {
  double rms_m = 0;
  double error_db = 0;  ///< RMS of it - target, re RMS of the target
  double level_db = 0;  ///< re the target
  /// Delay of the displacement relative to the target; removed from the error. None: not found.
  std::optional<double> shift_s;
};

/// A movement of the finger without turning, during playback.
struct PlayedStroke {
  double from_s = 0, to_s = 0;  ///< since the first tick
  double from_m = 0, to_m = 0;
  double target_rms_m = 0;                                  ///< 0 if unknown, or below 1 pm
  StrokeDisplacement predicted;                             ///< error and level only if the target is known
  std::optional<StrokeDisplacement> measured;               ///< none: no sensor, or samples are missing
  std::uint64_t limited_ticks = 0;                          ///< by amplitude or slew
  std::uint64_t energy_limited_ticks = 0, gated_ticks = 0;  ///< reduced; without contact
  std::optional<LimitTally> limits;                         ///< none: unknown
};

struct StrokeSpeed {
  double mean_mps = 0;  ///< of all strokes; 0: there is none
  /// Share of the texture's power in the band at that speed (spatial::band_kept_percent); none: several
  /// textures, or not the one that was played.
  std::optional<double> power_kept_percent;
};

struct StrokeReport {
  std::vector<PlayedStroke> strokes;  ///< the first kMostStrokesKept
  std::uint64_t stroke_count = 0;     ///< of all
  std::optional<LimitTally> limits;   ///< of the whole session; none: unknown
  double low_hz = 0, high_hz = 0;     ///< the band of all displacements
  double last_gain = 1;               ///< at the end, as a factor of the textures' own gains
  StrokeSpeed speed;
  std::vector<std::string> notes;  ///< what could not be judged, and why
  bool damaged = false;            ///< the file is damaged, and the rest of it is not in the report
};

/// An hour at three strokes a second.
inline constexpr std::size_t kMostStrokesKept = 10000;

/// The length of a block that is judged at once, and of its surroundings. What the band's filters take from
/// farther away is neglected. Their edges are raised cosines of 3 and 5 Hz, whose impulse responses fall with
/// the third power of time: from over 5 s away comes at most 5e-4 of the largest value there, if all of it is
/// at an edge.
struct JudgedBlocks {
  double block_s = 20, around_s = 5;
};

struct StrokeListener {
  std::function<void(const PlayedStroke&)> stroke;  ///< each one in order, also those that are not kept
  std::function<void(double)> progress;             ///< 0 to 1
};

/// Target: as TargetReader, with the gain of the commands and changes of texture. Periods without a tick are
/// filled, for one stop at most so many that the rows before it have no influence after it. Predicted: the
/// recorded drive through the model of the transducer's file (with the hysteresis of the file): the
/// actuator's response if that file is correct, without a finger on it. Measured, if the device reports its
/// tray: the session's samples (block_judge.hpp). All in the same band. A stroke is at least 5 mm long. The
/// effect of the limits: read_unlimited_where_known(), with a note if it is unknown. Memory depends neither
/// on the length of the session nor on that of a stroke: it is that of a block (JudgedBlocks; 200,000 rows at
/// 10 kHz) and its textures, of the strokes kept, and of the commands. A block has less than 2^24 readings.
/// Errors: as session_overview. If a texture is missing or has changed, or if the session lacks the
/// block that describes a change, the strokes with a part of it have no target, with a note. If ticks are
/// missing, the strokes that end before them are judged, as if the drive ended there, with a note; the effect
/// of the limits in them is not reported. Blind ticks are in no stroke, with a note.
schema::Result<StrokeReport> report_strokes(const std::string& name, const StrokeListener& listener = {},
                                            const JudgedBlocks& blocks = {});

/// The speed that report_strokes() reports, without its judgement of the displacement and the memory of a
/// block.
schema::Result<StrokeSpeed> stroke_speed(const std::string& name);

}  // namespace tacto::playback

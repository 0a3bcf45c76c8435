// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the strokes of the finger in a record, from its position alone.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "spatial/strokes/frame_range.hpp"
#include "spatial/strokes/position_facts.hpp"
#include "spatial/strokes/position_jumps.hpp"

namespace tacto::spatial {

/// One stroke: a motion of the finger in one direction.
struct Stroke {
  FrameRange frames;
  int direction = 1;                                ///< +1 if the encoder counts up
  double from_m = 0, to_m = 0;                      ///< positions of the first and last frame
  std::optional<double> force_n = std::nullopt;     ///< mean normal force, if it is known
  bool finger_up = false;                           ///< according to that force; see touch_record.hpp
  std::optional<PositionJump> jump = std::nullopt;  ///< of the position, which cuts it: not a whole stroke

  double advance_m() const { return direction * (to_m - from_m); }
};

/// The sections of a record between its gaps. `gaps` are sorted by frame, as in recordings.
std::vector<FrameRange> pieces_between_gaps(std::size_t frames, std::span<const schema::Gap> gaps);

/// Strokes by time, by the rule of stroke_rule.hpp; the only place where it is applied to a recording. A
/// stroke begins and ends at a tenth of its own travelling speed, and reaches half of it. A reversal, a gap
/// or a pause of kStrokePause_s ends it. Shorter pauses belong to the stroke, so a finger that sticks and
/// slips makes one stroke; so do short movements back (5 % of the distance before or after) within such a
/// pause. A run shorter than kShortestStroke_m, than kShortestOfLongest of the longest run, or than 20
/// resolutions of the position, is not a stroke. If the position is so coarse that a speed of 1 mm/s is not
/// visible, the parts between strokes are searched again with a longer window. Memory: a chunk, a window of
/// at most 0.5 s, and the list. Errors: of reading.
struct FoundStrokes {
  std::vector<Stroke> strokes;
  std::size_t short_runs = 0;  ///< over 20 resolutions, but too short for a stroke
  double longest_m = 0;        ///< of the strokes and short runs
};
schema::Result<FoundStrokes> find_strokes(const ReadFrames& read, std::span<const FrameRange> pieces,
                                          double sample_rate_hz, const PositionFacts& facts);

/// The largest movement back within a section, against its direction: 0 for a monotone one. m.
double backward_travel(std::span<const double> position_m, int direction);

}  // namespace tacto::spatial

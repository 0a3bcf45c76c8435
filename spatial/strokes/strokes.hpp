// SPDX-License-Identifier: GPL-3.0-or-later
// Where in a record the finger strokes, found from its position alone.
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

/// One stroke: the finger on its way in one direction.
struct Stroke {
  FrameRange frames;
  int direction = 1;                             ///< +1 as the encoder counts up
  double from_m = 0, to_m = 0;                   ///< positions of the first and last frame
  std::optional<double> force_n = std::nullopt;  ///< mean normal force, where it is known
  bool finger_up = false;                        ///< by that force; see finger_contact.hpp
  std::optional<PositionJump> jump =
      std::nullopt;  ///< of the position, that cuts it off: it is no whole stroke

  double advance_m() const { return direction * (to_m - from_m); }
};

/// The stretches of a record between its gaps. `gaps` sorted by frame, as recordings keep them.
std::vector<FrameRange> pieces_between_gaps(std::size_t frames, std::span<const schema::Gap> gaps);

/// Strokes by time. A stroke is a run above a tenth of its own travelling speed that somewhere reaches half
/// of it. A reversal, a gap or a pause of 0.1 s ends it; shorter pauses stay inside, so a finger that sticks
/// and slips makes one stroke, and so do short ways back (5 % of the way before or after) within such a
/// pause. What is shorter than 5 % of the longest stroke, or than 20 resolutions of the position, is none.
/// Where the position is so coarse that a speed of 1 mm/s would not show, what lies between strokes is
/// searched again with a longer window. Memory: a chunk, a window of 0.5 s at most, and the list. Errors: of
/// reading.
struct FoundStrokes {
  std::vector<Stroke> strokes;
  std::size_t short_runs = 0;  ///< long enough for the position to tell, and shorter than 5 % of the longest
};
schema::Result<FoundStrokes> find_strokes(const ReadFrames& read, std::span<const FrameRange> pieces,
                                          double sample_rate_hz, const PositionFacts& facts);

/// How far a stretch goes back at most, against its direction: 0 for a monotone one. m.
double backward_travel(std::span<const double> position_m, int direction);

}  // namespace tacto::spatial

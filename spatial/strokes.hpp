// SPDX-License-Identifier: GPL-3.0-or-later
// Where in a record the finger strokes, found from its position alone.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "data-schema/recording.hpp"

namespace tacto::spatial {

/// Frames [begin, end) of a record.
struct FrameRange {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// One stroke: the finger on its way in one direction.
struct Stroke {
  FrameRange frames;
  int direction = 1;  ///< +1 as the encoder counts up
};

/// The stretches of a record between its gaps. `gaps` sorted by frame, as recordings keep them.
std::vector<FrameRange> pieces_between_gaps(std::size_t frames, std::span<const schema::Gap> gaps);

/// Strokes by time. A stroke is a run above a tenth of its own travelling speed that somewhere reaches half
/// of it. A reversal, a gap or a pause of 0.1 s ends it; shorter pauses stay inside. What is shorter than 5 %
/// of the longest stroke, or than 20 quanta, is none. Positions in m, one a frame.
std::vector<Stroke> find_strokes(std::span<const double> position_m, double sample_rate_hz,
                                 std::span<const schema::Gap> gaps = {});

/// How far a stretch goes back at most, against its direction: 0 for a monotone one. m.
double backward_travel(std::span<const double> position_m, int direction);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of a position that are too fast for a finger: an encoder that lost its count, a cable, a torn frame.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/strokes/frame_range.hpp"

namespace tacto::spatial {

/// The position of `frame` differs by `step_m` from that of the frame before.
struct PositionJump {
  std::size_t frame = 0;
  double step_m = 0;
};

/// Ten times the fastest stroke that this program is made for.
inline constexpr double kFastestFinger_mps = 10;

/// The jumps within the pieces, by time. A step is a jump if it exceeds kFastestFinger_mps since the position
/// last changed (a slow encoder's position is held; at most 50 ms), and exceeds 20 times the median step of
/// the moving finger. If over 1 % of the steps are like that, they are the normal behaviour of this position,
/// and there are no jumps. Reads all frames once, and twice more if a step may be a jump. Errors: of reading.
schema::Result<std::vector<PositionJump>> find_position_jumps(const ReadFrames& read,
                                                              std::span<const FrameRange> pieces,
                                                              double sample_rate_hz);

/// The pieces, each cut before the frames with a jump.
std::vector<FrameRange> pieces_between_jumps(std::span<const FrameRange> pieces,
                                             std::span<const PositionJump> jumps);

}  // namespace tacto::spatial

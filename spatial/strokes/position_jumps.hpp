// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of a position that no finger makes: an encoder that lost its count, a cable, a torn frame.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/strokes/frame_range.hpp"

namespace tacto::spatial {

/// The position of `frame` lies `step_m` from that of the frame before.
struct PositionJump {
  std::size_t frame = 0;
  double step_m = 0;
};

/// The jumps within the pieces, by time. A step is one where it takes 10 m/s, ten times the fastest stroke
/// that this program is made for, since the position last changed (a slow encoder's position is held; 50 ms
/// at most), and is over 20 times the median step of the moving finger. Where over 1 % of the steps are like
/// that there are none: so the position goes. Reads all once, twice more where a step may be a jump. Errors:
/// of reading.
schema::Result<std::vector<PositionJump>> find_position_jumps(const ReadFrames& read,
                                                              std::span<const FrameRange> pieces,
                                                              double sample_rate_hz);

/// The pieces, each cut before the frames that jump.
std::vector<FrameRange> pieces_between_jumps(std::span<const FrameRange> pieces,
                                             std::span<const PositionJump> jumps);

}  // namespace tacto::spatial

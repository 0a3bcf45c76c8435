// SPDX-License-Identifier: GPL-3.0-or-later
// Short gaps of a recording, filled by interpolation, so that a stroke does not end at them.
#pragma once

#include <memory>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "spatial/strokes/frame_range.hpp"
#include "spatial/strokes/touch_source.hpp"

namespace tacto::spatial {

/// A longer gap ends a stroke: in frames, and from the frame before it to the frame after it.
inline constexpr std::uint64_t kMostFilledFrames = 4;
inline constexpr double kLongestFilled_s = 0.5e-3;

struct BridgedTouch {
  std::unique_ptr<TouchSource> source;
  schema::RecordingHeader header;  ///< `frames` counts the filled ones, `gaps` are the others
  std::vector<FrameRange> filled;  ///< by frame, in the numbers of `source`
};

/// Fills gaps of at most kMostFilledFrames and kLongestFilled_s: a quarter of a period at the usual upper end
/// of the band, 500 Hz. The value by the cubic through the two frames before and after the gap; of a sine of
/// 500 Hz at 10 kHz its error is 0.2 % of the amplitude for one missing frame, 3 % for four (the remainder of
/// Lagrange's formula: prod |x - x_i| / 24 times the fourth derivative). Position and normal force on the
/// straight line: at 10 m/s^2 the error is below 0.3 um. A gap stays if fewer than two frames are between it
/// and the next one or an end, or if the position moves over it faster than a finger (kFastestFinger_mps).
/// Errors: of reading.
schema::Result<BridgedTouch> bridge_short_gaps(std::unique_ptr<TouchSource> source,
                                               schema::RecordingHeader header);

}  // namespace tacto::spatial

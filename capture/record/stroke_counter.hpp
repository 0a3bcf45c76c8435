// SPDX-License-Identifier: GPL-3.0-or-later
// Counts strokes during a recording, for the live view and for an end after a number of strokes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tacto::capture {

/// Counts strokes from positions, frame by frame, by the rule of stroke_rule.hpp as far as it can be applied
/// before the recording is complete: motion in one direction over at least kShortestStroke_m. A stroke is
/// counted when the finger has moved back by kTurn_m or has rested for kStrokePause_s. The strokes that a
/// recording stores are found afterwards (store_strokes).
class StrokeCounter {
 public:
  static constexpr double kTurn_m = 0.5e-3;

  explicit StrokeCounter(double sample_rate_hz) : rate_hz_(sample_rate_hz) {}

  void add(double position_m);
  std::size_t strokes() const { return strokes_; }

 private:
  void begin(double position_m);

  double rate_hz_;
  std::size_t strokes_ = 0;
  std::uint64_t frame_ = 0;
  // Of the current motion: the place before it, and the farthest position with its frame.
  double from_m_ = 0, furthest_m_ = 0;
  std::uint64_t furthest_frame_ = 0;
  int direction_ = 0;  // 0 until the motion has reached kTurn_m
};

}  // namespace tacto::capture

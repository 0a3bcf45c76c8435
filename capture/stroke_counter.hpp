// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes counted while they are made, for the one who coaches the finger.
#pragma once

#include <cstdint>
#include <vector>

namespace tacto::capture {

/// A stroke that has ended.
struct CountedStroke {
  std::uint64_t first_frame = 0, frames = 0;
  double length_m = 0;
  int direction = 1;  ///< -1: backwards
  double mean_speed_mps = 0;
  double mean_normal_n = 0;  ///< 0 where no normal force is recorded
  std::uint64_t clipped_samples = 0;
};

/// Feeds on positions, frame by frame. A stroke goes one way for at least kShortest_m; it ends where the
/// finger has turned back by kTurn_m or stood still for kRest_s. A count for coaching, not the strokes that
/// `spatial` finds. Memory: the strokes.
class StrokeCounter {
 public:
  static constexpr double kShortest_m = 5e-3, kTurn_m = 0.5e-3, kRest_s = 0.15;

  explicit StrokeCounter(double sample_rate_hz) : rate_hz_(sample_rate_hz) {}

  /// `clipped` samples of this frame are at an end of their converter's range.
  void add(double position_m, double normal_n, std::uint64_t clipped = 0);
  const std::vector<CountedStroke>& strokes() const { return strokes_; }

 private:
  void begin(double position_m);
  void end();

  double rate_hz_;
  std::vector<CountedStroke> strokes_;
  std::uint64_t frame_ = 0;
  // Of the movement at hand: where it began, the furthest that it came, and the load until then.
  double from_m_ = 0, furthest_m_ = 0;
  std::uint64_t from_frame_ = 0, furthest_frame_ = 0;
  double load_sum_n_ = 0, load_until_furthest_n_ = 0;
  std::uint64_t clipped_ = 0, clipped_until_furthest_ = 0;
  int direction_ = 0;  // 0 until it has moved by kTurn_m
};

}  // namespace tacto::capture

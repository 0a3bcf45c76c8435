// SPDX-License-Identifier: GPL-3.0-or-later
// Counts strokes during a recording, as feedback for the experimenter.
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
  double mean_normal_n = 0;  ///< 0 if no normal force is recorded
  std::uint64_t clipped_samples = 0;
};

/// Counts strokes from positions, frame by frame. A stroke is motion in one direction over at least
/// kShortest_m. It ends when the finger has moved back by kTurn_m or has been at rest for kRest_s, or at the
/// end of the stream (finish()). Rest before and after the motion is not part of it. This count is feedback
/// and may differ from the strokes that `spatial` finds. Memory: the strokes.
class StrokeCounter {
 public:
  static constexpr double kShortest_m = 5e-3, kTurn_m = 0.5e-3, kRest_s = 0.15;
  /// A finger within kStill_m of a place is at rest; at the end of a stream it has to be at rest for
  /// kStopped_s.
  static constexpr double kStill_m = 0.1e-3, kStopped_s = 0.02;

  explicit StrokeCounter(double sample_rate_hz) : rate_hz_(sample_rate_hz) {}

  /// `clipped` samples of this frame are at an end of their converter's range.
  void add(double position_m, double normal_n, std::uint64_t clipped = 0);
  /// The stream has ended: counts the current motion if it has stopped. A motion that was cut off is no
  /// stroke.
  void finish();
  const std::vector<CountedStroke>& strokes() const { return strokes_; }

 private:
  void begin(double position_m);
  void end();
  void stand(double position_m);
  void reach(double position_m);

  /// The farthest position so far, in steps of kStill_m, with the sums from the start of the motion to it.
  struct Step {
    double at_m = 0;
    std::uint64_t frame = 0;
    double load_n = 0;
    std::uint64_t clipped = 0;
  };
  const Step& last_step() const;

  double rate_hz_;
  std::vector<CountedStroke> strokes_;
  std::uint64_t frame_ = 0;
  // Of the current motion: the place before it, the place and frame at which it starts, the farthest
  // position, the last two steps to that position, and the sums since the start.
  double from_m_ = 0, left_m_ = 0, furthest_m_ = 0;
  std::uint64_t left_frame_ = 0, furthest_frame_ = 0;
  Step reached_, before_;
  double load_sum_n_ = 0;
  std::uint64_t clipped_ = 0;
  int direction_ = 0;  // 0 until the motion has reached kTurn_m
};

}  // namespace tacto::capture

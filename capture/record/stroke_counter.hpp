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
/// finger has turned back by kTurn_m or stood still for kRest_s, or where the stream ends behind it
/// (finish()). What it stood before and after is no part of it. A count for coaching, not the strokes that
/// `spatial` finds. Memory: the strokes.
class StrokeCounter {
 public:
  static constexpr double kShortest_m = 5e-3, kTurn_m = 0.5e-3, kRest_s = 0.15;
  /// Within so far of a place it stands there; and for so long at a stream's end, it has come to a stop.
  static constexpr double kStill_m = 0.1e-3, kStopped_s = 0.02;

  explicit StrokeCounter(double sample_rate_hz) : rate_hz_(sample_rate_hz) {}

  /// `clipped` samples of this frame are at an end of their converter's range.
  void add(double position_m, double normal_n, std::uint64_t clipped = 0);
  /// The stream has ended: counts the movement at hand if it had come to a stop. One cut off is no stroke.
  void finish();
  const std::vector<CountedStroke>& strokes() const { return strokes_; }

 private:
  void begin(double position_m);
  void end();
  void stand(double position_m);
  void reach(double position_m);

  /// How far it came, in steps of kStill_m, with what was summed up from leaving to there.
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
  // Of the movement at hand: where it began, where it was left for good, the furthest that it came, the last
  // two steps of the way there, and the load since leaving.
  double from_m_ = 0, left_m_ = 0, furthest_m_ = 0;
  std::uint64_t left_frame_ = 0, furthest_frame_ = 0;
  Step reached_, before_;
  double load_sum_n_ = 0;
  std::uint64_t clipped_ = 0;
  int direction_ = 0;  // 0 until it has moved by kTurn_m
};

}  // namespace tacto::capture

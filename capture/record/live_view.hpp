// SPDX-License-Identifier: GPL-3.0-or-later
// The figures that an experimenter watches during a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/statistics.hpp"

namespace tacto::capture {

/// One channel since the previous view.
struct ChannelLevel {
  double smallest = 0, largest = 0;  ///< in the channel's unit
  bool clipped = false;              ///< a sample is at an end of its converter's range
  double unchanged_s = 0;            ///< since its code last changed, lost frames not counted
};

struct LiveView {
  double time_s = 0;                 ///< lost frames included
  std::vector<ChannelLevel> levels;  ///< one per channel
  std::optional<double> speed_mps;   ///< of the finger, mean of the last 0.1 s; none without a position
  std::optional<double> normal_n;    ///< likewise
  std::size_t strokes = 0;
  std::uint64_t lost_frames = 0;
  std::uint64_t disk_left_bytes = 0;
};

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

/// Computes the figures of a view from the blocks of a stream. For use in one thread.
class LiveFigures {
 public:
  /// `header` must exist as long as this object.
  explicit LiveFigures(const schema::RecordingHeader& header);

  /// Whole frames, in stored codes.
  void add(std::span<const std::int32_t> codes);
  const schema::RecordingHeader& header() const { return header_; }
  const std::vector<schema::Statistics>& statistics() const { return statistics_; }
  std::size_t strokes() const { return counter_.strokes(); }
  /// The figures since the last call; the caller adds time, losses and disk space.
  LiveView take_view();

 private:
  void add_motion(std::span<const std::int32_t> codes);
  double physical(std::span<const std::int32_t> codes, std::size_t frame, std::size_t channel) const;
  // Continues when the 32-bit counter overflows.
  double next_position_m(std::int32_t code);

  const schema::RecordingHeader& header_;
  std::optional<std::size_t> position_, normal_;
  std::vector<schema::Statistics> statistics_, recent_;
  std::vector<std::int32_t> last_codes_;
  std::vector<std::uint64_t> unchanged_;  // frames
  StrokeCounter counter_;
  std::uint64_t recent_frames_ = 0;
  std::int32_t last_code_ = 0;
  std::int64_t unwrapped_ = 0;  // the code of the position, with the overflows of the counter
  double last_position_m_ = 0, moved_m_ = 0, load_sum_n_ = 0;
  bool begun_ = false;
};

}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
// The figures that an experimenter watches during a recording.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/record/stroke_counter.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/statistics.hpp"

namespace tacto::capture {

/// One channel since the previous view.
struct ChannelLevel {
  double smallest = 0, largest = 0;  ///< in the channel's unit
  bool clipped = false;              ///< a sample is at an end of its converter's range
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
  StrokeCounter counter_;
  std::uint64_t recent_frames_ = 0;
  std::int32_t last_code_ = 0;
  std::int64_t unwrapped_ = 0;  // the code of the position, with the overflows of the counter
  double last_position_m_ = 0, moved_m_ = 0, load_sum_n_ = 0;
  bool begun_ = false;
};

}  // namespace tacto::capture

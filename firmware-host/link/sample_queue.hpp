// SPDX-License-Identifier: GPL-3.0-or-later
// A queue of frames between the wire and the reader, in order, with gaps.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "data-schema/recording/recording.hpp"
#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::firmware_host {

/// The device numbers the frames: a missing number is a gap, a repeated one is dropped. Memory: the frames
/// that have not been read.
class SampleQueue {
 public:
  void begin(std::size_t channels);
  void push(const wire::Samples& samples);

  /// Whole frames before the next gap.
  std::size_t frames() const;
  bool has_gap() const { return !gaps_.empty(); }
  bool at_gap() const { return !gaps_.empty() && gaps_.front().frame == taken_; }
  /// The gap before the next frame: `frame` is the number of frames read before it. Precondition: at_gap().
  schema::Gap take_gap();
  /// Fills whole frames, at most frames(); returns their number.
  std::size_t take(std::span<std::int32_t> interleaved);
  std::uint64_t pushed() const { return pushed_; }
  std::uint64_t lost() const { return lost_; }

 private:
  void note_gap(std::uint64_t first_frame);
  void compact();

  std::size_t channels_ = 1;
  std::vector<std::int32_t> codes_;
  std::size_t used_ = 0;  // of codes_
  std::deque<schema::Gap> gaps_;
  std::uint64_t taken_ = 0, pushed_ = 0;  // frames
  std::uint64_t next_frame_ = 0, lost_ = 0;
};

}  // namespace tacto::firmware_host

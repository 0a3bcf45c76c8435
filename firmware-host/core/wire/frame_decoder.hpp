// SPDX-License-Identifier: Apache-2.0
// A stream of bytes, cut anywhere and damaged anyhow, back into frames.
#pragma once

#include "firmware-host/core/wire/frame.hpp"

namespace tacto::wire {

/// What a decoder came upon.
enum class Arrival : uint8_t {
  nothing,    ///< all bytes are taken, and no frame is complete
  frame,      ///< a whole one, its check right
  oversize,   ///< a sound header that announces more than kMaxPayload
  bad_check,  ///< a frame whose bytes are not what was sent
  truncated,  ///< a frame that another begins inside of: its end never came
};

struct DecoderCounts {
  uint32_t frames = 0;
  uint32_t dropped_bytes = 0;  ///< of no frame, and of the damaged ones
  uint32_t oversize = 0, bad_check = 0, truncated = 0;
};

/// After damage it looks for the next header at every byte, so a sound frame behind a damaged one is never
/// lost. Whoever sends, it needs kMaxFrame bytes of memory and no time beyond that of checking each byte
/// once, and once more for each false start.
class FrameDecoder {
 public:
  /// Takes bytes up to the next event; `used` says how many. Call again with the rest, also after the last
  /// byte was taken, until `nothing`: damaged bytes may hide frames.
  Arrival take(const uint8_t* bytes, size_t size, size_t& used, Frame& frame) noexcept;
  /// The stream has ended. `truncated` where it did so within a frame.
  Arrival finish() noexcept;
  const DecoderCounts& counts() const noexcept { return counts_; }

 private:
  bool fill(size_t target, const uint8_t* bytes, size_t size, size_t& used) noexcept;
  void drop(size_t count) noexcept;
  void seek_header() noexcept;
  Arrival refuse_oversize() noexcept;
  Arrival check(Frame& frame) noexcept;
  Arrival refuse(size_t total) noexcept;
  bool header_within(size_t total) const noexcept;

  uint8_t buffer_[kMaxFrame];
  size_t filled_ = 0;
  size_t delivered_ = 0;  // bytes of the frame that the caller has in hand
  DecoderCounts counts_;
};

}  // namespace tacto::wire

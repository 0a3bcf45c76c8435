// SPDX-License-Identifier: Apache-2.0
// Finds the frames in a stream of bytes that may be truncated or damaged at any place.
#pragma once

#include "firmware-host/core/wire/frame.hpp"

namespace tacto::wire {

/// The result of the decoder for the bytes so far.
enum class Arrival : uint8_t {
  nothing,    ///< all bytes are consumed, and no frame is complete
  frame,      ///< an intact frame
  oversize,   ///< an intact header that announces more than kMaxPayload
  bad_check,  ///< a frame whose check is wrong
  truncated,  ///< the same, with another header inside: its end is missing
};

struct DecoderCounts {
  uint32_t frames = 0;
  uint32_t dropped_bytes = 0;  ///< bytes that are not part of an intact frame
  uint32_t oversize = 0, bad_check = 0, truncated = 0;
};

/// After damaged bytes it searches for the next header at every byte, so an intact frame after a damaged one
/// is never lost. It needs kMaxFrame bytes of memory. It checks each byte once, and once more for each false
/// header, for any input.
class FrameDecoder {
 public:
  /// Consumes bytes up to the next event; `used` is their number. Call it again with the rest, also after the
  /// last byte, until it returns `nothing`: damaged bytes may contain frames.
  Arrival take(const uint8_t* bytes, size_t size, size_t& used, Frame& frame) noexcept;
  /// Call at the end of the stream. `truncated` if it ends within a frame.
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
  size_t delivered_ = 0;  // bytes of the frame that was returned to the caller
  DecoderCounts counts_;
};

}  // namespace tacto::wire

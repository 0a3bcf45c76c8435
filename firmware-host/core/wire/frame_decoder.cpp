// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/wire/frame_decoder.hpp"

#include "firmware-host/core/wire/crc32c.hpp"

namespace tacto::wire {

bool FrameDecoder::fill(size_t target, const uint8_t* bytes, size_t size, size_t& used) noexcept {
  if (filled_ >= target) return true;
  const size_t lacking = target - filled_, there = size - used;
  const size_t taken = lacking < there ? lacking : there;
  if (taken > 0) __builtin_memcpy(buffer_ + filled_, bytes + used, taken);
  filled_ += taken;
  used += taken;
  return filled_ >= target;
}

void FrameDecoder::drop(size_t count) noexcept {
  filled_ -= count;
  if (filled_ > 0) __builtin_memmove(buffer_, buffer_ + count, filled_);
}

// Drops the bytes before the next place where a header may begin.
void FrameDecoder::seek_header() noexcept {
  size_t place = 1;
  while (place < filled_ && buffer_[place] != kSync0) ++place;
  counts_.dropped_bytes += static_cast<uint32_t>(place);
  drop(place);
}

bool FrameDecoder::header_within(size_t total) const noexcept {
  FrameHeader header;
  for (size_t i = 1; i + kHeaderSize <= total; ++i)
    if (buffer_[i] == kSync0 && read_header(buffer_ + i, header)) return true;
  return false;
}

Arrival FrameDecoder::refuse(size_t total) noexcept {
  const bool cut = header_within(total);
  ++(cut ? counts_.truncated : counts_.bad_check);
  seek_header();
  return cut ? Arrival::truncated : Arrival::bad_check;
}

Arrival FrameDecoder::refuse_oversize() noexcept {
  ++counts_.oversize;
  seek_header();
  return Arrival::oversize;
}

Arrival FrameDecoder::check(Frame& frame) noexcept {
  const size_t end = kHeaderSize + frame.header.length;
  uint32_t sent = 0;
  FieldReader(buffer_ + end, kCheckSize)(sent);
  if (sent != crc32c(buffer_, end)) return refuse(end + kCheckSize);
  frame.payload = buffer_ + kHeaderSize;
  delivered_ = end + kCheckSize;
  ++counts_.frames;
  return Arrival::frame;
}

Arrival FrameDecoder::take(const uint8_t* bytes, size_t size, size_t& used, Frame& frame) noexcept {
  used = 0;
  drop(delivered_);
  delivered_ = 0;
  for (;;) {
    if (!fill(kHeaderSize, bytes, size, used)) return Arrival::nothing;
    if (!read_header(buffer_, frame.header)) {
      seek_header();
      continue;
    }
    if (frame.header.length > kMaxPayload) return refuse_oversize();
    if (!fill(kHeaderSize + frame.header.length + kCheckSize, bytes, size, used)) return Arrival::nothing;
    return check(frame);
  }
}

Arrival FrameDecoder::finish() noexcept {
  drop(delivered_);
  delivered_ = 0;
  const bool cut = filled_ > 0;
  counts_.dropped_bytes += static_cast<uint32_t>(filled_);
  counts_.truncated += cut;
  filled_ = 0;
  return cut ? Arrival::truncated : Arrival::nothing;
}

}  // namespace tacto::wire

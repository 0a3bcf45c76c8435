// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/wire/frame.hpp"

#include "firmware-host/core/wire/crc32c.hpp"

namespace tacto::wire {
namespace {

constexpr size_t kCheckedHeader = 10;

uint16_t header_check(const uint8_t* bytes) noexcept {
  return static_cast<uint16_t>(crc32c(bytes, kCheckedHeader));
}

}  // namespace

size_t seal_frame(const FrameHeader& header, uint8_t* frame) noexcept {
  FieldWriter head(frame, kHeaderSize);
  head(kSync0, kSync1, header.major, header.type, header.length, header.sequence);
  head(header_check(frame));
  const size_t end = kHeaderSize + header.length;
  FieldWriter tail(frame + end, kCheckSize);
  tail(crc32c(frame, end));
  return end + kCheckSize;
}

bool read_header(const uint8_t* bytes, FrameHeader& header) noexcept {
  uint8_t sync0 = 0, sync1 = 0;
  uint16_t check = 0;
  FieldReader reader(bytes, kHeaderSize);
  reader(sync0, sync1, header.major, header.type, header.length, header.sequence, check);
  return sync0 == kSync0 && sync1 == kSync1 && check == header_check(bytes);
}

}  // namespace tacto::wire

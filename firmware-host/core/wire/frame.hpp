// SPDX-License-Identifier: Apache-2.0
// The envelope of every message: 12 bytes before it, 4 after it (core/WIRE.md).
#pragma once

#include "firmware-host/core/wire/field_codec.hpp"

namespace tacto::wire {

inline constexpr uint8_t kProtocolMajor = 1;
inline constexpr uint8_t kProtocolMinor = 0;

inline constexpr uint8_t kSync0 = 0xA5, kSync1 = 0x54;
inline constexpr size_t kHeaderSize = 12, kCheckSize = 4;
inline constexpr size_t kMaxPayload = 2112;
inline constexpr size_t kMaxFrame = kHeaderSize + kMaxPayload + kCheckSize;

struct FrameHeader {
  uint8_t major = kProtocolMajor;
  uint8_t type = 0;
  uint16_t length = 0;  ///< of the payload, bytes
  uint32_t sequence = 0;
};

/// An intact frame. The payload is memory of the decoder, valid until its next call.
struct Frame {
  FrameHeader header;
  const uint8_t* payload = nullptr;
};

/// Adds header and check to a payload that is at frame + kHeaderSize. Returns the frame's size.
size_t seal_frame(const FrameHeader& header, uint8_t* frame) noexcept;

/// True if a valid header is at `bytes` (kHeaderSize of them): the marks and the check are right.
bool read_header(const uint8_t* bytes, FrameHeader& header) noexcept;

/// Writes a message as a frame. Returns its size, or 0 if it does not fit in `capacity` or kMaxPayload.
template <class Message>
size_t encode_frame(const Message& message, uint32_t sequence, uint8_t* frame, size_t capacity) noexcept {
  if (capacity < kHeaderSize + kCheckSize) return 0;
  const size_t room = capacity - kHeaderSize - kCheckSize;
  FieldWriter writer(frame + kHeaderSize, room < kMaxPayload ? room : kMaxPayload);
  Message::fields(writer, message);
  if (!writer.ok()) return 0;
  return seal_frame(
      {kProtocolMajor, static_cast<uint8_t>(Message::kType), static_cast<uint16_t>(writer.size()), sequence},
      frame);
}

}  // namespace tacto::wire

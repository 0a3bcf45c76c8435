// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes in pieces for the frame decoder; every decoded frame is parsed as every message. A parsed message
// must encode, and parse to the same message again.
#include <cstdlib>
#include <cstring>

#include "firmware-host/core/wire/frame_decoder.hpp"
#include "tests/firmware-host/wire_messages.hpp"

namespace {

using namespace tacto;

void demand(bool holds) {
  if (!holds) std::abort();
}

template <class Message>
void there_and_back(const wire::Frame& frame) {
  static Message message, again;
  if (wire::parse(frame.payload, frame.header.length, message) != wire::Parse::ok) return;
  static std::uint8_t first[wire::kMaxFrame], second[wire::kMaxFrame];
  const std::size_t size = wire::encode_frame(message, 1, first, sizeof first);
  demand(size >= wire::kHeaderSize + wire::kCheckSize);
  const std::size_t payload = size - wire::kHeaderSize - wire::kCheckSize;
  demand(wire::parse(first + wire::kHeaderSize, payload, again) == wire::Parse::ok);
  demand(wire::encode_frame(again, 1, second, sizeof second) == size &&
         std::memcmp(first, second, size) == 0);
}

template <class... Messages>
void as_each(const wire::Frame& frame, std::tuple<Messages...>*) {
  (there_and_back<Messages>(frame), ...);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::size_t piece = 1 + data[0];
  wire::FrameDecoder decoder;
  std::size_t frames_size = 0;
  for (std::size_t at = 1; at < size;) {
    const std::size_t end = std::min(size, at + piece);
    for (wire::Arrival arrival = wire::Arrival::frame; arrival != wire::Arrival::nothing;) {
      wire::Frame frame;
      std::size_t used = 0;
      arrival = decoder.take(data + at, end - at, used, frame);
      at += used;
      if (arrival != wire::Arrival::frame) continue;
      frames_size += wire::kHeaderSize + frame.header.length + wire::kCheckSize;
      as_each(frame, static_cast<tests::AllMessages*>(nullptr));
    }
    demand(at == end);
  }
  decoder.finish();
  demand(frames_size + decoder.counts().dropped_bytes == size - 1);
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Every message of the wire as a list of types, and messages filled at random: a third codec, which fills the
// members instead of parsing them.
#pragma once

#include <cstdint>
#include <cstring>
#include <random>
#include <tuple>
#include <vector>

#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::tests {

using AllMessages =
    std::tuple<wire::Hello, wire::StreamStart, wire::StreamStop, wire::Limits, wire::ProfileBegin,
               wire::ProfileChunk, wire::ProfileEnd, wire::Filters, wire::Gain, wire::Sweep, wire::Arm,
               wire::Play, wire::Stop, wire::Disarm, wire::Drive, wire::Heartbeat, wire::Reset, wire::Welcome,
               wire::ProfileLevels, wire::Taps, wire::Tracking, wire::Energy, wire::Contact, wire::Change,
               wire::Hysteresis, wire::Channel, wire::Note, wire::Answer, wire::Samples, wire::Ticks,
               wire::Pulse, wire::Fault, wire::ForceLimits, wire::ScenePart, wire::Set, wire::Move,
               wire::Raise, wire::Axes, wire::AxisTicks>;

class RandomFields {
 public:
  explicit RandomFields(std::uint64_t seed) : random_(seed) {}

  template <class... Fields>
  void operator()(Fields&... fields) {
    (draw(fields), ...);
  }
  template <class T>
  void array(T* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) draw(values[i]);
  }
  template <class T>
  std::size_t count(T& value, std::size_t most) {
    return value = static_cast<T>(random_() % (most + 1));
  }

 private:
  template <class T>
  void draw(T& value) {
    const std::uint64_t bits = random_();
    std::memcpy(&value, &bits, sizeof value);
  }
  template <std::size_t kSize>
  void draw(char (&text)[kSize]) {
    array(text, kSize - 1);
  }
  std::mt19937_64 random_;
};

template <class Message>
Message random_message(std::uint64_t seed) {
  Message message{};
  RandomFields random(seed);
  Message::fields(random, message);
  return message;
}

template <class Message>
std::vector<std::uint8_t> framed(const Message& message, std::uint32_t sequence) {
  std::vector<std::uint8_t> bytes(wire::kMaxFrame);
  bytes.resize(wire::encode_frame(message, sequence, bytes.data(), bytes.size()));
  return bytes;
}

}  // namespace tacto::tests

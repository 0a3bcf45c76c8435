// SPDX-License-Identifier: GPL-3.0-or-later
// Converts values to fields of the wire.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "data-schema/recording/recording.hpp"
#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::firmware_host {

/// UTF-8, padded with zeros; a text that is too long is cut before the first character that does not fit.
template <std::size_t kSize>
void put_text(char (&field)[kSize], std::string_view text) {
  std::size_t size = std::min(text.size(), kSize - 1);
  const auto continues = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80; };
  while (size < text.size() && size > 0 && continues(size)) --size;
  std::fill(std::copy_n(text.begin(), size, field), field + kSize, '\0');
}

inline wire::Note note_of(wire::NoteKind kind, std::string_view text) {
  wire::Note note;
  note.kind = kind;
  put_text(note.text, text);
  return note;
}

/// Single precision, rounded towards zero, so that the core's limit is never above the transducer's.
inline float not_above(double limit) {
  const auto nearest = static_cast<float>(limit);
  return static_cast<double>(nearest) > limit ? std::nextafter(nearest, 0.0F) : nearest;
}

inline std::uint32_t millihertz(double rate_hz) {
  return static_cast<std::uint32_t>(std::llround(rate_hz * 1e3));
}

/// Sets the index in each message of a list.
template <class Message>
std::vector<Message> numbered(std::vector<Message> messages) {
  for (std::size_t i = 0; i < messages.size(); ++i) messages[i].index = static_cast<std::uint8_t>(i);
  return messages;
}

/// The channels of a board in this process.
inline std::vector<wire::Channel> wire_channels(const std::vector<schema::Channel>& channels) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<wire::Channel> messages;
  for (const schema::Channel& channel : channels) {
    wire::Channel& message = messages.emplace_back();
    put_text(message.name, channel.name);
    put_text(message.quantity, channel.quantity);
    put_text(message.unit, channel.unit);
    put_text(message.source, channel.source);
    put_text(message.calibrated, channel.calibrated);
    message.scale = channel.scale;
    message.offset = channel.offset;
    message.range_min = channel.range_min.value_or(kNone);
    message.range_max = channel.range_max.value_or(kNone);
    message.native_rate_hz = channel.native_rate_hz.value_or(kNone);
  }
  return numbered(std::move(messages));
}

/// What the axis of this name (x, y, z) moves along, and the reverse.
inline wire::AxisAlong along_of(std::string_view name) {
  return name == "x" ? wire::AxisAlong::x : name == "y" ? wire::AxisAlong::y : wire::AxisAlong::z;
}
inline std::string name_of(wire::AxisAlong along) {
  return along == wire::AxisAlong::x ? "x" : along == wire::AxisAlong::y ? "y" : "z";
}

}  // namespace tacto::firmware_host

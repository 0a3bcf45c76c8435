// SPDX-License-Identifier: GPL-3.0-or-later
// A board whose inputs are a session's, around the firmware's own core.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "data-schema/session/session.hpp"
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/wire/frame_decoder.hpp"

namespace tacto::playback {

/// Whether these bytes are one whole frame.
bool is_frame(std::span<const std::uint8_t> bytes);

/// The message in a frame, where it is one of its kind. Precondition: is_frame().
template <class Message>
std::optional<Message> message_in_frame(std::span<const std::uint8_t> frame) {
  Message message;
  const std::size_t payload = frame.size() - wire::kHeaderSize - wire::kCheckSize;
  if (static_cast<wire::MessageType>(frame[3]) != Message::kType ||
      wire::parse(frame.data() + wire::kHeaderSize, payload, message) != wire::Parse::ok)
    return std::nullopt;
  return message;
}

/// Precondition: its frame is_frame().
inline wire::MessageType type_of(const schema::SessionCommand& command) {
  return static_cast<wire::MessageType>(command.frame[3]);
}

/// Whether ticks say that the finger touches: from protocol 1.2 on. Older sessions do not name the protocol.
bool tells_touch(const schema::SessionHeader& header);

/// Whether amplitude, slew and energy hold the drive, or let through what the kernel wishes.
enum class BoardLimits { recorded, lifted };

inline constexpr std::size_t kMostProfileSamples = std::size_t{1}
                                                   << 24;  // as much as prepare() makes at most

/// Encoder, enable input and touch are as told; the drive is kept.
class SessionBoard {
 public:
  explicit SessionBoard(const schema::SessionHeader& header, BoardLimits limits = BoardLimits::recorded,
                        std::size_t profile_samples = kMostProfileSamples);
  SessionBoard(const SessionBoard&) = delete;
  SessionBoard& operator=(const SessionBoard&) = delete;

  /// Before arming: where the encoder is.
  void rest_at(std::int32_t encoder) { encoder_ = encoder; }
  /// Hands a frame to the core; gives its answer, none where there was none. Precondition: is_frame().
  std::optional<wire::Answer> say_frame(std::span<const std::uint8_t> frame);
  template <class Message>
  std::optional<wire::Answer> say(const Message& message) {
    std::uint8_t frame[wire::kMaxFrame];
    const std::size_t size = wire::encode_frame(message, 0, frame, sizeof frame);
    return say_frame(std::span<const std::uint8_t>(frame, size));
  }
  /// One tick; the drive of it.
  float tick(const schema::SessionTick& recorded);

 private:
  static SessionBoard& of(void* board) noexcept { return *static_cast<SessionBoard*>(board); }
  core::Board board();
  core::Hal hal();
  void listen();
  std::vector<std::uint8_t> as_replayed(std::span<const std::uint8_t> frame) const;
  std::uint32_t unseen_in(const schema::SessionTick& recorded) const;

  schema::SessionHeader header_;
  BoardLimits limits_;
  std::size_t profile_samples_;
  std::unique_ptr<float[]> profile_;
  std::vector<std::uint8_t> from_host_, to_host_;
  wire::FrameDecoder decoder_;
  std::optional<wire::Answer> answer_;
  std::uint32_t sequence_ = 0;
  std::int32_t encoder_ = 0;
  std::uint32_t unseen_ = 0;
  wire::Channel force_;  // of the finger: 1 N where it touches
  std::int32_t touching_ = 0;
  bool enabled_ = true;
  float drive_v_ = 0;
  std::uint64_t clock_ = 0;
  std::unique_ptr<core::Firmware> firmware_;
};

}  // namespace tacto::playback

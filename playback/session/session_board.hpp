// SPDX-License-Identifier: GPL-3.0-or-later
// The firmware's own core on a board whose inputs come from a session.
#pragma once

#include <array>
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

/// The message in a frame, if it is of this type. Precondition: is_frame().
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

/// Whether the limits of amplitude, slew and energy act as recorded, or not at all.
enum class BoardLimits { recorded, lifted };

inline constexpr std::size_t kMostProfileSamples = std::size_t{1}
                                                   << 24;  // the largest number that prepare() makes

/// Encoder, enable input and contact are those of the recorded tick; the drive is stored.
class SessionBoard {
 public:
  explicit SessionBoard(const schema::SessionHeader& header, BoardLimits limits = BoardLimits::recorded,
                        std::size_t profile_samples = kMostProfileSamples);
  SessionBoard(const SessionBoard&) = delete;
  SessionBoard& operator=(const SessionBoard&) = delete;

  /// Sets the encoders before arming.
  void rest_at(const schema::SessionTick& first) { encoder_ = first.encoder, counts_ = first.counts; }
  /// Of the last tick, of a force device.
  const std::array<float, wire::kMaxAxes>& force_n() const { return force_n_; }
  const core::SceneKernel& scene() const { return firmware_->scene(); }
  /// Gives a frame to the core; returns its answer, if there is one. Precondition: is_frame().
  std::optional<wire::Answer> send_frame(std::span<const std::uint8_t> frame);
  template <class Message>
  std::optional<wire::Answer> say(const Message& message) {
    std::uint8_t frame[wire::kMaxFrame];
    const std::size_t size = wire::encode_frame(message, 0, frame, sizeof frame);
    return send_frame(std::span<const std::uint8_t>(frame, size));
  }
  /// Runs one tick; returns its drive.
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
  wire::Channel force_;  // of the finger: 1 N in contact
  std::int32_t touching_ = 0;
  bool enabled_ = true;
  wire::Axes axes_;
  std::array<std::int32_t, wire::kMaxAxes> counts_ = {};
  std::array<float, wire::kMaxAxes> force_n_ = {};
  float drive_v_ = 0;
  std::uint64_t clock_ = 0;
  std::unique_ptr<core::Firmware> firmware_;
};

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a session of what the page's device did.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "analysis/live/live_scene.hpp"
#include "analysis/live/live_texture.hpp"
#include "data-schema/files/files.hpp"
#include "firmware-host/core/wire/frame_decoder.hpp"
#include "firmware-host/link/wire_words.hpp"
#include "playback/player/flight_recorder.hpp"
#include "playback/wasm/browser_board.hpp"

namespace tacto::analysis {

struct KeptSession {
  std::string path;
  std::uint64_t ticks = 0;
  std::uint64_t lost_ticks = 0;  ///< that did not arrive, or that the disk did not accept
};

/// The page sends a log of its wire: from arming on, each frame that its device accepted or sent, in order.
/// They become a session in a temporary file, which is removed with this object unless it is kept.
class LiveSession {
 public:
  /// The session will be named after LiveTexture::session_stem and the time. Errors: cannot_write.
  static schema::Result<std::unique_ptr<LiveSession>> begin(const LiveTexture& texture);
  static schema::Result<std::unique_ptr<LiveSession>> begin(const LiveScene& scene);
  ~LiveSession();

  /// The page's device has accepted the frames of another texture; what comes of the log begins with the
  /// command that changes to it. Errors: malformed, after the session's end.
  schema::Result<void> change(const LiveChange& change);
  /// Any part of the log. Errors: malformed, for bytes that are not frames, frames that are no part of such a
  /// log, or ticks that come twice; unsuitable, after kLongestS. After an error the session ends here.
  schema::Result<void> take(std::span<const std::uint8_t> log);
  /// Ends the session and gives it its name. Errors: cannot_write; unsuitable, if it has no ticks or is kept.
  schema::Result<KeptSession> keep();
  /// The device's fault that the log contained, since the last call.
  std::optional<firmware_host::FaultWords> take_fault() { return std::exchange(fault_, std::nullopt); }

 private:
  LiveSession() = default;
  // Before the ticks the session has the frames that were uploaded.
  static schema::Result<std::unique_ptr<LiveSession>> begin(const std::string& name_before,
                                                            schema::SessionHeader header,
                                                            std::span<const Frame> upload);
  schema::Result<void> take(const wire::Frame& frame, std::span<const std::uint8_t> whole);
  template <class Message>
  schema::Result<void> take_ticks(const Message& message);

  schema::PendingFiles pending_;
  std::string path_;
  std::unique_ptr<playback::FlightRecorder> recorder_;  // null: ended
  wire::FrameDecoder decoder_;
  std::uint64_t ticks_ = 0, missing_ = 0, most_ticks_ = 0;
  std::int64_t period_ns_ = 0;
  std::optional<firmware_host::FaultWords> fault_;
};

/// Ten minutes; of a texture 270 MB.
inline constexpr std::uint64_t kLongestS = 600;

}  // namespace tacto::analysis

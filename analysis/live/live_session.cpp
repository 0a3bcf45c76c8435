// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>

#include "playback/player/player.hpp"
#include "playback/player/session_name.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::string_view kWhere = "the page's log";

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

schema::SessionHeader in_browser(schema::SessionHeader header) {
  const wire::Channel channel = browser::encoder_channel();
  const wire::Welcome about = browser::board(channel, nullptr).about;
  header.clock_hz = static_cast<std::uint32_t>(std::lround(header.rate_hz)) * browser::kClocksPerTick;
  header.device_uri = "browser:";
  header.device_name = about.name;
  header.device_firmware = about.firmware;
  header.device_protocol = fmt::format("{}.{}", about.major, about.minor);
  header.simulated = "the page of tactograph live";
  return header;
}

bool is_steering(wire::MessageType type) {
  return wire::steers(type) || type == wire::MessageType::arm;
}

tl::unexpected<schema::Error> odd_log(std::string what) {
  return fail(ErrorKind::malformed, std::move(what), std::string(kWhere), "load the page again");
}

}  // namespace

Result<std::unique_ptr<LiveSession>> LiveSession::begin(const LiveTexture& texture) {
  return begin(texture.session_stem, texture.program.session, texture.upload);
}

// The first frame describes the page's device: it is no command.
Result<std::unique_ptr<LiveSession>> LiveSession::begin(const LiveScene& scene) {
  return begin(schema::stem_of(scene.file, ".scene"), scene.program.session,
               std::span(scene.upload).subspan(1));
}

Result<std::unique_ptr<LiveSession>> LiveSession::begin(const std::string& name_before,
                                                        schema::SessionHeader header,
                                                        std::span<const Frame> upload) {
  std::unique_ptr<LiveSession> session(new LiveSession);
  session->period_ns_ = std::llround(1e9 / header.rate_hz);
  session->most_ticks_ = static_cast<std::uint64_t>(std::llround(header.rate_hz)) * kLongestS;
  session->path_ = playback::dated_session(name_before + "-");
  const auto temporary = session->pending_.add(session->path_);
  TACTO_TRY(temporary);
  unlink(temporary->c_str());  // it is empty, and the recorder makes it
  auto recorder =
      playback::FlightRecorder::begin(*temporary, in_browser(std::move(header)), playback::FullQueue::wait);
  TACTO_TRY(recorder);
  session->recorder_ = std::move(*recorder);
  for (const Frame& frame : upload) session->recorder_->command({0, steady_ns(), frame});
  TACTO_TRY(session->recorder_->start());
  return session;
}

LiveSession::~LiveSession() = default;

Result<void> LiveSession::change(const LiveChange& change) {
  if (recorder_ == nullptr) return odd_log("comes after the session's end");
  recorder_->change({ticks_, steady_ns(), change.program});
  for (const Frame& frame : change.frames) recorder_->command({ticks_, steady_ns(), frame});
  recorder_->event({ticks_, steady_ns(), "texture changed to " + change.program.textures.front().file});
  return {};
}

Result<void> LiveSession::take(std::span<const std::uint8_t> log) {
  if (recorder_ == nullptr) return odd_log("comes after the session's end");
  wire::Frame frame;
  std::size_t at = 0;
  for (wire::Arrival arrival = wire::Arrival::frame; at < log.size() || arrival != wire::Arrival::nothing;) {
    std::size_t used = 0;
    arrival = decoder_.take(log.data() + at, log.size() - at, used, frame);
    at += used;
    if (decoder_.counts().dropped_bytes > 0) return odd_log("contains bytes that are not frames");
    if (arrival != wire::Arrival::frame) continue;
    // The frame in the decoder's memory: its payload follows the header.
    const std::size_t size = wire::kHeaderSize + frame.header.length + wire::kCheckSize;
    TACTO_TRY(take(frame, {frame.payload - wire::kHeaderSize, size}));
  }
  return {};
}

Result<void> LiveSession::take(const wire::Frame& frame, std::span<const std::uint8_t> whole) {
  const auto type = static_cast<wire::MessageType>(frame.header.type);
  if (is_steering(type)) {
    recorder_->command({ticks_, steady_ns(), {whole.begin(), whole.end()}});
    return {};
  }
  wire::Ticks ticks;
  if (type == wire::MessageType::ticks &&
      wire::parse(frame.payload, frame.header.length, ticks) == wire::Parse::ok)
    return take_ticks(ticks);
  wire::AxisTicks axis_ticks;
  if (type == wire::MessageType::axis_ticks &&
      wire::parse(frame.payload, frame.header.length, axis_ticks) == wire::Parse::ok)
    return take_ticks(axis_ticks);
  wire::Fault fault;
  if (type == wire::MessageType::fault &&
      wire::parse(frame.payload, frame.header.length, fault) == wire::Parse::ok) {
    fault_ = firmware_host::words_of(fault.code, fault.detail);
    recorder_->event({ticks_, steady_ns(), "fault: " + fault_->what});
    return {};
  }
  return odd_log(fmt::format("contains a frame of type {:#x}, which is no part of it", frame.header.type));
}

template <class Message>
Result<void> LiveSession::take_ticks(const Message& message) {
  if (message.first_tick < ticks_) return odd_log("contains ticks twice");
  if (message.first_tick > most_ticks_ - wire::kMaxBlockTicks)
    return fail(ErrorKind::unsuitable, "a session has at most ten minutes", std::string(kWhere),
                "keep this part, and begin again");
  if (const std::uint64_t lost = message.first_tick - ticks_; lost > 0) {
    recorder_->loss({ticks_, lost, schema::SessionLoss::Why::link});
    missing_ += lost;
  }
  const auto first_ns =
      static_cast<std::int64_t>(message.device_ticks / browser::kClocksPerTick) * period_ns_;
  for (std::uint8_t i = 0; i < message.count; ++i) {
    schema::SessionTick row = playback::session_tick(message, i);
    row.tick = message.first_tick + i;
    row.time_ns = first_ns + i * period_ns_;
    recorder_->tick(row);
  }
  ticks_ = message.first_tick + message.count;
  return {};
}

Result<KeptSession> LiveSession::keep() {
  if (recorder_ == nullptr || ticks_ == 0)
    return fail(ErrorKind::unsuitable, "there is nothing to keep", std::string(kWhere), "play first");
  const auto closed = recorder_->close();
  const std::uint64_t unwritten = recorder_->counts().lost();
  recorder_.reset();
  TACTO_TRY(closed);
  TACTO_TRY(pending_.commit(schema::Existing::keep));
  return KeptSession{path_, ticks_ - missing_ - unwritten, missing_ + unwritten};
}

}  // namespace tacto::analysis

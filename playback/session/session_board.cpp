// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/session_board.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-host/link/hosted_board.hpp"
#include "firmware-host/link/wire_fields.hpp"

namespace tacto::playback {
namespace {

constexpr std::uint32_t kReplayClockHz = 1'000'000;

// No drive reaches them, and their ratio does not shorten the longest possible release.
constexpr float kNoDriveLimitV = 1e12F, kNoSlewLimitVPerS = 1e30F;

wire::Axes axes_of(const schema::SessionForces& forces) {
  wire::Axes axes;
  axes.count = static_cast<std::uint8_t>(forces.axes.size());
  axes.peak_n = static_cast<float>(forces.peak_n);
  axes.continuous_n = static_cast<float>(forces.continuous_n);
  axes.slew_n_per_s = static_cast<float>(forces.slew_n_per_s);
  std::ranges::transform(forces.axes, axes.axes, [](const schema::DeviceAxis& axis) {
    return wire::Axis{firmware_host::along_of(axis.name),
                      {},
                      static_cast<float>(axis.peak_force_n),
                      static_cast<float>(axis.continuous_force_n),
                      static_cast<float>(axis.encoder_step_m),
                      axis.travel_from_m,
                      axis.travel_to_m};
  });
  return axes;
}

template <class Message>
std::vector<std::uint8_t> frame_of(const Message& message) {
  std::vector<std::uint8_t> frame(wire::kMaxFrame);
  frame.resize(wire::encode_frame(message, 0, frame.data(), frame.size()));
  return frame;
}

// The device has decided with its channel and units, and its ticks report the decision. So the gate of the
// replay gets a force of one newton or none.
wire::Contact as_decided(const wire::Contact& contact) {
  const float threshold = contact.on_n > 0 ? 0.5F : 0;
  return {0, {}, threshold, threshold, 1, 0};
}

wire::Limits lifted(wire::Limits limits) {
  limits.drive_v = kNoDriveLimitV;
  limits.slew_v_per_s = kNoSlewLimitVPerS;
  return limits;
}

}  // namespace

bool is_frame(std::span<const std::uint8_t> bytes) {
  wire::FrameHeader header;
  const std::size_t around = wire::kHeaderSize + wire::kCheckSize;
  return bytes.size() >= around && wire::read_header(bytes.data(), header) &&
         header.length <= wire::kMaxPayload && bytes.size() == around + header.length;
}

SessionBoard::SessionBoard(const schema::SessionHeader& header, BoardLimits limits,
                           std::size_t profile_samples)
    : header_(header),
      limits_(limits),
      profile_samples_(profile_samples),
      profile_(std::make_unique_for_overwrite<float[]>(profile_samples)),
      encoder_(header.initial_encoder) {
  firmware_ = std::make_unique<core::Firmware>(board(), hal());
  say(wire::Hello{});
}

core::Board SessionBoard::board() {
  core::Board board;
  board.profile_memory = profile_.get();
  board.profile_samples = static_cast<std::uint32_t>(profile_samples_);
  board.channels = &force_;
  board.channel_count = 1;
  wire::Welcome& about = board.about;
  about.features = wire::kFeatureDrive;
  about.clock_hz = kReplayClockHz;
  const std::uint32_t rate = firmware_host::millihertz(header_.rate_hz);
  about.default_rate_millihertz = about.least_rate_millihertz = about.most_rate_millihertz = rate;
  about.drive_limit_v = static_cast<float>(header_.transducer.drive_limit_v);
  about.slew_limit_v_per_s = static_cast<float>(header_.transducer.slew_limit_v_per_s);
  if (limits_ == BoardLimits::lifted) {
    about.drive_limit_v = kNoDriveLimitV;
    about.slew_limit_v_per_s = kNoSlewLimitVPerS;
  }
  if (header_.forces) {
    axes_ = axes_of(*header_.forces);
    board.axes = &axes_;
  }
  return board;
}

core::Hal SessionBoard::hal() {
  core::Hal hal;
  hal.board = this;
  hal.read_encoder = [](void* b) noexcept { return of(b).encoder_; };
  hal.encoder_unseen = [](void* b) noexcept { return of(b).unseen_; };
  hal.read_channels = [](void* b, std::int32_t* codes) noexcept {
    codes[0] = of(b).touching_;
    return true;
  };
  hal.write_drive = [](void* b, float volts) noexcept { of(b).drive_v_ = volts; };
  hal.read_axes = [](void* b, std::int32_t* counts) noexcept {
    std::copy_n(of(b).counts_.begin(), of(b).axes_.count, counts);
  };
  hal.write_forces = [](void* b, const float* force_n) noexcept {
    std::copy_n(force_n, of(b).axes_.count, of(b).force_n_.begin());
  };
  hal.enable_closed = [](void* b) noexcept { return of(b).enabled_; };
  hal.clock = [](void* b) noexcept { return of(b).clock_; };
  hal.set_rate = [](void*, std::uint32_t) noexcept {};
  firmware_host::use_queues<SessionBoard, &SessionBoard::from_host_, &SessionBoard::to_host_>(hal);
  hal.restart = [](void*) noexcept {};
  return hal;
}

// Of the core's messages only answers are needed.
void SessionBoard::listen() {
  std::size_t at = 0;
  wire::Frame frame;
  for (wire::Arrival arrival = wire::Arrival::frame;
       at < to_host_.size() || arrival != wire::Arrival::nothing;) {
    std::size_t used = 0;
    arrival = decoder_.take(to_host_.data() + at, to_host_.size() - at, used, frame);
    at += used;
    if (arrival != wire::Arrival::frame) continue;
    wire::Answer answer;
    const bool is_answer = frame.header.type == static_cast<std::uint8_t>(wire::MessageType::answer);
    if (is_answer && wire::parse(frame.payload, frame.header.length, answer) == wire::Parse::ok)
      answer_ = answer;
  }
  to_host_.clear();
}

std::vector<std::uint8_t> SessionBoard::as_replayed(std::span<const std::uint8_t> frame) const {
  if (const auto contact = message_in_frame<wire::Contact>(frame)) return frame_of(as_decided(*contact));
  if (limits_ == BoardLimits::lifted) {
    if (const auto limits = message_in_frame<wire::Limits>(frame)) return frame_of(lifted(*limits));
    if (message_in_frame<wire::Energy>(frame)) return frame_of(wire::Energy{0, 1});
  }
  return {frame.begin(), frame.end()};
}

// Each frame gets the next sequence number, because the core drops repeated ones.
std::optional<wire::Answer> SessionBoard::send_frame(std::span<const std::uint8_t> frame) {
  std::vector<std::uint8_t> sealed = as_replayed(frame);
  const wire::FrameHeader header{
      wire::kProtocolMajor, sealed[3],
      static_cast<std::uint16_t>(sealed.size() - wire::kHeaderSize - wire::kCheckSize), sequence_++};
  sealed.resize(wire::seal_frame(header, sealed.data()));
  from_host_.insert(from_host_.end(), sealed.begin(), sealed.end());
  answer_.reset();
  firmware_->poll();
  listen();
  return answer_;
}

// The number of unseen periods is not recorded. Its effect is: a blind tick, a jump (fault), or nothing.
std::uint32_t SessionBoard::unseen_in(const schema::SessionTick& recorded) const {
  if ((recorded.flags & wire::kTickBlind) != 0) return UINT32_MAX;
  const bool fault = (recorded.flags & wire::kTickFault) != 0;
  return fault ? 0 : core::blind_ticks(static_cast<float>(header_.rate_hz));
}

float SessionBoard::tick(const schema::SessionTick& recorded) {
  encoder_ = recorded.encoder;
  counts_ = recorded.counts;
  enabled_ = (recorded.flags & wire::kTickEnabled) != 0;
  touching_ = (recorded.flags & wire::kTickTouching) != 0 ? 1 : 0;
  unseen_ = unseen_in(recorded);
  clock_ += static_cast<std::uint64_t>(std::llround(kReplayClockHz / header_.rate_hz));
  firmware_->tick();
  firmware_->poll();
  to_host_.clear();
  return drive_v_;
}

}  // namespace tacto::playback

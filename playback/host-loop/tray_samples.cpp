// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/host-loop/tray_samples.hpp"

#include <cmath>
#include <cstring>

#include "firmware-host/link/wire_fields.hpp"

namespace tacto::playback {
namespace {

using schema::Result;

constexpr std::uint8_t kFramesOfMessage = 32;  // the wire's largest number
constexpr std::size_t kTypeOfFrame = 3;

}  // namespace

std::optional<std::size_t> tray_sensor_channel(const firmware_host::Description& about) {
  for (std::size_t i = 0; i < about.channels.size(); ++i) {
    const wire::Channel& channel = about.channels[i];
    if (std::strcmp(channel.quantity, "displacement") == 0 && std::strcmp(channel.unit, "m") == 0 &&
        std::isfinite(channel.scale) && channel.scale != 0 && std::isfinite(channel.offset))
      return i;
  }
  return std::nullopt;
}

bool TraySamples::streams(std::span<const std::uint8_t> frame) {
  const auto type = static_cast<wire::MessageType>(frame[kTypeOfFrame]);
  return type == wire::MessageType::stream_start || type == wire::MessageType::stream_stop;
}

std::optional<schema::SessionSensor> TraySamples::sensor(double rate_hz) const {
  if (!channel_) return std::nullopt;
  const wire::Channel& channel = client_.description().channels[*channel_];
  return schema::SessionSensor{channel.name, channel.source, channel.calibrated,
                               rate_hz,      channel.scale,  channel.offset};
}

void TraySamples::begin(double rate_hz, SampleRun::Sink sink) {
  rate_hz_ = rate_hz;
  force_n_.reset();
  run_.reset();
  if (channel_) run_.emplace(rate_hz, std::move(sink));
}

Result<void> TraySamples::begin_stream() {
  if (!run_ && force_ == nullptr) return {};
  next_frame_ = 0;
  const auto begun = client_.start_stream(firmware_host::millihertz(rate_hz_), kFramesOfMessage);
  streams_ = begun.has_value();
  return begun;
}

// The last message gives the time of its first frame; the times of the others follow from their numbers and
// the rate.
void TraySamples::take() {
  if (!streams_ || !client_.last_arrival()) return;
  const firmware_host::FrameArrival& arrival = *client_.last_arrival();
  auto& queue = client_.samples();
  const std::size_t channels = client_.description().channels.size();
  for (bool more = true; more;) {
    while (queue.at_gap()) next_frame_ += queue.take_gap().count;
    codes_.resize(queue.frames() * channels);
    const std::size_t frames = queue.take(codes_);
    more = frames > 0;
    for (std::size_t i = 0; i < frames; ++i, ++next_frame_) {
      const double since = static_cast<double>(next_frame_) - static_cast<double>(arrival.frame);
      const double time_s = arrival.device_s + since / rate_hz_;
      if (force_ != nullptr) take_force(codes_[i * channels + force_->index], time_s);
      if (run_) run_->add(next_frame_, std::llround(1e9 * time_s), codes_[i * channels + *channel_]);
    }
  }
}

void TraySamples::take_force(std::int32_t code, double time_s) {
  force_s_ = time_s;
  const double now_n = code * force_->scale + force_->offset;
  const double before_n = force_n_.value_or(now_n);
  force_n_ = before_n - (now_n - before_n) * std::expm1(-1 / (kForceMeanS * rate_hz_));
}

Result<void> TraySamples::end_stream() {
  if (!streams_) return {};
  const auto ended = client_.stop_stream();
  take();
  streams_ = false;
  return ended;
}

void TraySamples::end() {
  if (run_) run_->flush();
  run_.reset();
  streams_ = false;
}

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/link/wire_device.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "firmware-host/link/code_range.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr double kBlockS = 5e-3;  // of frames in a message: imperceptible in a live view
// On a serial line, where the 40 bytes of each message count: 2.5 bytes for each frame.
constexpr double kLineBlockFrames = 16, kLineBlockS = 0.5;
constexpr double kClockPairEveryS = 1;

std::uint8_t block_frames(double rate_hz, double baud) {
  if (std::isfinite(baud))
    return static_cast<std::uint8_t>(std::clamp(rate_hz * kLineBlockS, 1.0, kLineBlockFrames));
  return static_cast<std::uint8_t>(std::clamp(rate_hz * kBlockS, 1.0, double{wire::kMaxBlockFrames}));
}

// The counters wrap, and so does their difference.
std::uint32_t damaged(const LinkCounts& link) {
  return link.frames.oversize + link.frames.bad_check + link.frames.truncated;
}

}  // namespace

WireDevice::WireDevice(std::unique_ptr<Client> client, Capabilities capabilities)
    : client_(std::move(client)), capabilities_(std::move(capabilities)) {}

Result<std::unique_ptr<WireDevice>> WireDevice::open(std::string uri, std::unique_ptr<Transport> transport) {
  auto client = Client::connect(std::move(transport), uri);
  TACTO_TRY(client);
  auto capabilities = capabilities_of((*client)->description(), std::move(uri));
  TACTO_TRY(capabilities);
  return std::unique_ptr<WireDevice>(new WireDevice(std::move(*client), std::move(*capabilities)));
}

Result<void> WireDevice::start() {
  counts_ = {};
  link_at_start_ = client_->counts();
  events_ = {};
  ended_.reset();
  next_pair_s_ = -std::numeric_limits<double>::infinity();
  const std::uint32_t rate = client_->description().welcome.default_rate_millihertz;
  const auto started =
      client_->start_stream(rate, block_frames(capabilities_.sample_rate_hz, client_->transport().baud()));
  started_ = started.has_value();
  return started;
}

// A loss is counted when its gap is returned, not when it is detected, because readers compare the two.
void WireDevice::take_gaps() {
  while (client_->samples().at_gap()) {
    events_.gaps.push_back(client_->samples().take_gap());
    counts_.lost_frames += events_.gaps.back().count;
  }
}

void WireDevice::count(std::span<const std::int32_t> codes) {
  counts_.clipped += clipped_codes(codes, capabilities_.channels);
  counts_.frames += codes.size() / capabilities_.channels.size();
}

void WireDevice::note_clock() {
  const auto& arrival = client_->last_arrival();
  if (!arrival || arrival->host_s < next_pair_s_) return;
  next_pair_s_ = arrival->host_s + kClockPairEveryS;
  events_.clock_pairs.push_back({arrival->frame, arrival->device_s, arrival->host_s});
}

// Frames before an error are returned before the error.
Result<std::size_t> WireDevice::read(std::span<std::int32_t> interleaved) {
  if (!started_) return schema::fail(ErrorKind::device, "the device is not started", capabilities_.uri);
  const std::size_t channels = capabilities_.channels.size(), target = interleaved.size() / channels;
  for (;;) {
    take_gaps();
    if (!ended_)
      if (const auto here = client_->await_samples(target); !here) ended_ = here.error();
    take_gaps();
    const std::size_t taken = client_->samples().take(interleaved);
    count(interleaved.first(taken * channels));
    note_clock();
    if (taken > 0 || target == 0) return taken;
    if (ended_) return tl::unexpected(*ended_);
  }
}

Result<void> WireDevice::stop() {
  started_ = false;
  return client_->stop_stream();
}

StreamCounts WireDevice::counts() const {
  const LinkCounts link = client_->counts();
  StreamCounts counts = counts_;
  counts.damaged_messages = damaged(link) - damaged(link_at_start_);
  counts.missing_messages = link.lost - link_at_start_.lost;
  return counts;
}

StreamEvents WireDevice::take_events() {
  StreamEvents events = std::exchange(events_, {});
  for (const wire::Fault& fault : client_->take_faults())
    events.faults.push_back({counts_.frames, fault.code, fault.detail});
  return events;
}

Result<double> WireDevice::round_trip_s() {
  const auto asked = std::chrono::steady_clock::now();
  const auto pulse = client_->heartbeat();
  TACTO_TRY(pulse);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
}

}  // namespace tacto::firmware_host

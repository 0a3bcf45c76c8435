// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/replay/replay_device.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware-host/link/code_range.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::string_view kPaced = ",paced=1";

Capabilities capabilities_of(const schema::Recording& recording, std::string uri) {
  const schema::RecordingHeader& header = recording.header;
  Capabilities capabilities;
  capabilities.uri = std::move(uri);
  capabilities.name = "replay of " + recording.stem;
  capabilities.serial = header.serial;
  capabilities.firmware = header.firmware;
  capabilities.simulated = capabilities.simulated_device = header.simulated;
  capabilities.clock = header.clock;
  capabilities.sample_rate_hz = header.sample_rate_hz;
  capabilities.channels = header.channels;
  capabilities.transducer = header.transducer;
  capabilities.surface = header.surface;
  return capabilities;
}

}  // namespace

ReplayDevice::ReplayDevice(std::string uri, schema::Recording recording, bool paced)
    : recording_(std::move(recording)),
      paced_(paced),
      capabilities_(capabilities_of(recording_, std::move(uri))) {}

Result<void> ReplayDevice::start() {
  auto reader = schema::WavReader::open(schema::wav_path(recording_));
  TACTO_TRY(reader);
  reader_.emplace(std::move(*reader));
  if (paced_) pacer_.emplace();
  next_gap_ = 0;
  counts_ = {};
  events_ = {};
  return {};
}

// A gap before the next frame becomes an event; the following gap limits the number of frames.
std::size_t ReplayDevice::until_gap(std::size_t frames) {
  const auto& gaps = recording_.header.gaps;
  for (; next_gap_ < gaps.size() && gaps[next_gap_].frame <= counts_.frames; ++next_gap_) {
    events_.gaps.push_back(gaps[next_gap_]);
    counts_.lost_frames += gaps[next_gap_].count;
  }
  if (next_gap_ == gaps.size()) return frames;
  return std::min<std::uint64_t>(frames, gaps[next_gap_].frame - counts_.frames);
}

void ReplayDevice::count(std::span<const std::int32_t> codes) {
  counts_.clipped += clipped_codes(codes, capabilities_.channels);
  counts_.frames += codes.size() / capabilities_.channels.size();
}

Result<std::size_t> ReplayDevice::read(std::span<std::int32_t> interleaved) {
  if (!reader_) return schema::fail(ErrorKind::device, "the device is not started", capabilities_.uri);
  const std::size_t channels = capabilities_.channels.size();
  const auto got = reader_->read(interleaved.first(until_gap(interleaved.size() / channels) * channels));
  if (!got) return got;
  count(interleaved.first(*got * channels));
  if (pacer_) pacer_->wait_until(static_cast<double>(counts_.frames) / capabilities_.sample_rate_hz);
  return got;
}

Result<void> ReplayDevice::stop() {
  reader_.reset();
  return {};
}

StreamEvents ReplayDevice::take_events() {
  return std::exchange(events_, {});
}

Result<std::unique_ptr<Device>> open_replay_device(const std::string& uri, std::string_view parameters) {
  const bool paced = parameters.ends_with(kPaced);
  if (paced) parameters.remove_suffix(kPaced.size());
  if (parameters.empty())
    return schema::fail(ErrorKind::usage, "contains no recording", uri,
                        "give for example replay:oak, or replay:oak,paced=1");
  auto recording = schema::open_recording(std::string(parameters));
  TACTO_TRY(recording);
  if (recording->header.format != schema::SampleFormat::pcm32)
    return schema::fail(ErrorKind::unsuitable,
                        "contains numbers of another program, not codes of a converter", uri,
                        "only a recording of a device can be replayed");
  return std::make_unique<ReplayDevice>(uri, std::move(*recording), paced);
}

}  // namespace tacto::firmware_host

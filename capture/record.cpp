// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capture/record_header.hpp"

namespace tacto::capture {
namespace {

using firmware_host::Device;
using schema::Fault;
using schema::Result;

constexpr std::size_t kBlockFrames = 1024;  // 0.1 s at 10 kHz

// The stream of one recording: block by block from device to file, measured on the way.
struct Stream {
  Device& device;
  schema::RecordingWriter& writer;
  std::vector<schema::Statistics> statistics;
  std::vector<std::int32_t> block;

  Result<std::size_t> next(std::uint64_t frames_left);
  void measure(std::span<const std::int32_t> codes);
};

void Stream::measure(std::span<const std::int32_t> codes) {
  const auto& channels = writer.header().channels;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const schema::Channel& channel = channels[i % channels.size()];
    statistics[i % channels.size()].add(codes[i] * channel.scale + channel.offset);
  }
}

Result<std::size_t> Stream::next(std::uint64_t frames_left) {
  const std::size_t channels = statistics.size();
  const std::size_t asked = std::min<std::uint64_t>(frames_left, kBlockFrames) * channels;
  const auto frames = device.read(std::span(block).first(asked));
  if (!frames) return frames;
  const auto codes = std::span<const std::int32_t>(block).first(*frames * channels);
  measure(codes);
  const auto written = writer.write(codes);
  return written ? frames : schema::forward_error(written);
}

Result<std::uint64_t> frames_in(double time_s, double rate_hz) {
  const double frames = std::floor(time_s * rate_hz + 0.5);
  if (!(frames >= 1 && frames < 0x1p53))
    return schema::fail(Fault::usage, fmt::format("{:g} s is no time to record for", time_s), "time",
                        "give a time above zero, as 2s");
  return static_cast<std::uint64_t>(frames);
}

Result<void> pump(Stream& stream, std::uint64_t frames, const std::function<void(double)>& progress) {
  for (std::uint64_t done = 0; done < frames;) {
    const auto read = stream.next(frames - done);
    if (!read) return schema::forward_error(read);
    if (*read == 0) break;
    done += *read;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(frames));
  }
  if (stream.device.counts().frames > 0) return {};
  return schema::fail(Fault::device, "the device gave no frames", stream.device.capabilities().uri);
}

Result<Recorded> finish(Stream& stream, std::uint64_t frames) {
  const auto counts = stream.device.counts();
  for (std::string& warning : stream_warnings(counts, frames))
    stream.writer.header().warnings.push_back(std::move(warning));
  const auto recording = stream.writer.close();
  if (!recording) return schema::forward_error(recording);
  return Recorded{*recording, std::move(stream.statistics), counts};
}

}  // namespace

Result<Recorded> record(Device& device, const RecordRequest& request,
                        const std::function<void(double)>& progress) {
  const auto frames = frames_in(request.time_s, device.capabilities().sample_rate_hz);
  if (!frames) return schema::forward_error(frames);
  auto header = header_for(device.capabilities(), request);
  if (!header) return schema::forward_error(header);
  const std::size_t channels = header->channels.size();
  auto writer = schema::RecordingWriter::create(request.name, std::move(*header));
  if (!writer) return schema::forward_error(writer);
  if (const auto started = device.start(); !started) return schema::forward_error(started);
  Stream stream{device, *writer, std::vector<schema::Statistics>(channels),
                std::vector<std::int32_t>(kBlockFrames * channels)};
  const auto pumped = pump(stream, *frames, progress);
  const auto stopped = device.stop();
  if (!pumped) return schema::forward_error(pumped);
  if (!stopped) return schema::forward_error(stopped);
  return finish(stream, *frames);
}

}  // namespace tacto::capture

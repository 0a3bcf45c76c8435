// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/take.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capture/record/record_header.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr double kShortest_s = 0.1, kLongest_s = 600;  // 10 min of four channels at 10 kHz are 190 MB
constexpr double kSettling_s = 0.1;                    // of filters at the beginning of a stream
constexpr std::size_t kBlockFrames = 256;

void append(Take& take, std::span<const std::int32_t> codes) {
  const std::size_t channels = take.codes.size();
  for (std::size_t i = 0; i < codes.size(); ++i) take.codes[i % channels].push_back(codes[i]);
}

Result<void> fill(Take& take, firmware_host::Device& device, std::size_t frames) {
  std::vector<std::int32_t> block(kBlockFrames * take.codes.size());
  while (take.frames() < frames) {
    const std::size_t target = std::min(kBlockFrames, frames - take.frames());
    const auto got = device.read(std::span(block).first(target * take.codes.size()));
    TACTO_TRY(got);
    if (*got == 0) return schema::fail(ErrorKind::device, "the stream ended too early", take.header.device);
    append(take, std::span<const std::int32_t>(block).first(*got * take.codes.size()));
  }
  if (device.counts().lost_frames == 0) return {};
  return schema::fail(ErrorKind::device, fmt::format("{} frames were lost", device.counts().lost_frames),
                      take.header.device, "try again");
}

Result<double> time_in(const std::string& text, const std::string& whole) {
  auto time_s = schema::parse_quantity(text, schema::Dimension::time);
  if (!time_s) return schema::fail(ErrorKind::usage, time_s.error().what, whole, "for example oak@1s..3s");
  return time_s;
}

Result<void> check_source(const schema::Recording& recording) {
  if (recording.header.format != schema::SampleFormat::pcm32 || recording.header.serial.empty())
    return schema::fail(ErrorKind::unsuitable, "does not contain the device that recorded it", recording.stem,
                        "use recordings made by 'tactograph record'");
  return {};
}

Result<void> check_part(const schema::RecordingHeader& header, const std::string& name, std::uint64_t first,
                        std::uint64_t last) {
  for (const schema::Gap& gap : header.gaps)
    if (gap.frame > first && gap.frame < last)
      return schema::fail(ErrorKind::unsuitable, "frames are missing in this part", name,
                          "choose a part without gaps");
  if (static_cast<double>(last - first) >= kShortest_s * header.sample_rate_hz) return {};
  return schema::fail(ErrorKind::unsuitable, fmt::format("this part is shorter than {:g} s", kShortest_s),
                      name, "choose a longer part");
}

// A part that ends after the recording is an error of the user: probably the wrong recording.
Result<void> check_end(const schema::RecordingHeader& header, const RecordingPart& part) {
  const double end_s = schema::frame_time_s(header, header.frames);
  if (part.to_s == std::numeric_limits<double>::infinity() || part.to_s < end_s + 1 / header.sample_rate_hz)
    return {};
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("has {:.4g} s, but the part ends at {:g} s", end_s, part.to_s), part.name,
                      "give a part within the recording");
}

}  // namespace

Result<RecordingPart> parse_recording_part(const std::string& text) {
  const auto at = text.rfind('@');
  if (at == std::string::npos) return RecordingPart{text};
  const std::string span = text.substr(at + 1);
  const auto dots = span.find("..");
  if (dots == std::string::npos)
    return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a time range", span), text,
                        "for example oak@1s..3s");
  const auto from_s = time_in(span.substr(0, dots), text), to_s = time_in(span.substr(dots + 2), text);
  TACTO_TRY(from_s);
  TACTO_TRY(to_s);
  return RecordingPart{text.substr(0, at), *from_s, *to_s};
}

schema::Channel nominal(const schema::Channel& channel) {
  if (!channel.calibration) return channel;
  schema::Channel plain = channel;
  plain.scale = channel.calibration->nominal_scale;
  plain.offset = channel.calibration->nominal_offset;
  const auto back = [&](double physical) {
    return plain.physical((physical - channel.offset) / channel.scale);
  };
  if (plain.range_min) plain.range_min = back(*plain.range_min);
  if (plain.range_max) plain.range_max = back(*plain.range_max);
  plain.calibration.reset();
  return plain;
}

Result<Take> take_from(firmware_host::Device& device, double time_s) {
  if (!(time_s >= kShortest_s && time_s <= kLongest_s))
    return schema::fail(ErrorKind::usage,
                        fmt::format("{:g} s is not a possible duration of a calibration", time_s), "time",
                        fmt::format("give {:g} s to {:g} s", kShortest_s, kLongest_s));
  auto header = header_for(device.capabilities(), {});
  TACTO_TRY(header);
  for (schema::Channel& channel : header->channels)
    channel = nominal(channel);  // in a replay it may be calibrated
  const auto frames = static_cast<std::size_t>(time_s * header->sample_rate_hz);
  Take take{std::move(*header), device.capabilities().name, {}};
  take.codes.resize(take.header.channels.size());
  TACTO_TRY(device.start());
  const auto settling = static_cast<std::size_t>(kSettling_s * take.header.sample_rate_hz);
  const auto filled = fill(take, device, frames + settling);
  const auto stopped = device.stop();
  TACTO_TRY(filled);
  TACTO_TRY(stopped);
  for (std::vector<double>& codes : take.codes)
    codes.erase(codes.begin(), codes.begin() + static_cast<std::ptrdiff_t>(settling));
  return take;
}

Result<Take> take_from(const RecordingPart& part) {
  auto recording = schema::open_recording(part.name);
  TACTO_TRY(recording);
  TACTO_TRY(check_source(*recording));
  const schema::RecordingHeader& header = recording->header;
  TACTO_TRY(check_end(header, part));
  const std::uint64_t first = schema::frame_at(header, part.from_s);
  const std::uint64_t last = std::max(first, schema::frame_at(header, part.to_s));
  TACTO_TRY(check_part(header, part.name, first, last));
  Take take{header, {}, {}};
  for (std::size_t i = 0; i < header.channels.size(); ++i) {
    const auto codes = schema::read_stored(*recording, i);
    TACTO_TRY(codes);
    take.codes.emplace_back(codes->begin() + static_cast<std::ptrdiff_t>(first),
                            codes->begin() + static_cast<std::ptrdiff_t>(last));
    take.header.channels[i] = nominal(header.channels[i]);
  }
  std::erase_if(take.header.marks,
                [&](const schema::Mark& mark) { return mark.frame < first || mark.frame > last; });
  for (schema::Mark& mark : take.header.marks) mark.frame -= first;
  return take;
}

}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/recording_json.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

// There is no sidecar: there may be samples that can become a recording.
tl::unexpected<Error> absent_recording(const std::string& name, const std::string& stem) {
  if (is_file(stem + ".events.jsonl"))
    return fail(ErrorKind::unsuitable, "is not closed, or is still being recorded", name,
                fmt::format("'tactograph recover {}' makes a recording of the existing files", stem));
  if (is_file(stem + ".texture.json"))
    return fail(ErrorKind::unsuitable, "is a texture already, not a recording", stem + ".texture.json");
  const std::string samples = is_file(name) ? name : stem + ".wav";
  if (!is_file(samples))
    return fail(ErrorKind::not_found, "there is no such recording", name,
                "a recording is NAME.json and NAME.wav");
  return fail(ErrorKind::unsuitable, fmt::format("is not a recording: there is no {}.json", stem), samples,
              fmt::format("'tactograph import {} -o NAME' converts it to a recording", samples));
}

Result<void> check_frames(const RecordingHeader& header, const WavInfo& info, const std::string& wav) {
  if (info.frames < header.frames)
    return fail(ErrorKind::malformed,
                fmt::format("truncated: its sidecar has {} frames, the file {}", header.frames, info.frames),
                wav);
  if (info.frames > header.frames)
    return fail(ErrorKind::malformed,
                fmt::format("has {} frames, its sidecar {}", info.frames, header.frames), wav);
  return {};
}

Result<void> check_samples(const RecordingHeader& header, const WavInfo& info, const std::string& wav) {
  if (info.channels != header.channels.size())
    return fail(ErrorKind::malformed,
                fmt::format("has {} channels, its sidecar {}", info.channels, header.channels.size()), wav);
  if (info.integer != (header.format == SampleFormat::pcm32))
    return fail(ErrorKind::malformed, fmt::format("contains {}, its sidecar has another format", info.format),
                wav);
  if (info.sample_rate_hz != std::round(header.sample_rate_hz))
    return fail(
        ErrorKind::malformed,
        fmt::format("has a rate of {} Hz, its sidecar {} Hz", info.sample_rate_hz, header.sample_rate_hz),
        wav);
  return check_frames(header, info, wav);
}

// The most frequent wrong name is that of another kind of file.
Result<RecordingHeader> read_sidecar(const std::string& path) {
  const auto document = open_document(path, "recording");
  return document ? recording_header_from(*document, path) : forward_error(document);
}

Result<void> check_wav(const RecordingHeader& header, const std::string& wav) {
  const auto reader = WavReader::open(wav);
  return reader ? check_samples(header, reader->info(), wav) : forward_error(reader);
}

std::string channel_names(const RecordingHeader& header) {
  std::string names;
  for (const Channel& channel : header.channels) names += (names.empty() ? "" : ", ") + channel.name;
  return names;
}

}  // namespace

Result<Recording> open_recording(const std::string& name) {
  const std::string stem = stem_of(name, "");
  const std::string sidecar = stem + ".json";
  if (!is_file(sidecar)) return absent_recording(name, stem);
  auto header = read_sidecar(sidecar);
  TACTO_TRY(header);
  Recording recording{std::move(*header), stem};
  TACTO_TRY(check_wav(recording.header, wav_path(recording)));
  return recording;
}

Result<void> check_samples_sum(const Recording& recording) {
  return check_sum(wav_path(recording), recording.header.sha256);
}

std::string wav_path(const Recording& recording) {
  return (fs::path(recording.stem).parent_path() / recording.header.wav_file).string();
}

Result<std::size_t> find_channel(const RecordingHeader& header, std::string_view name) {
  const auto found = std::ranges::find(header.channels, name, &Channel::name);
  if (found != header.channels.end()) return static_cast<std::size_t>(found - header.channels.begin());
  return fail(ErrorKind::unsuitable, fmt::format("there is no channel '{}'", name), header.wav_file,
              "its channels are: " + channel_names(header));
}

Result<std::vector<double>> read_stored(const Recording& recording, std::size_t channel) {
  return read_wav_channel(wav_path(recording), channel);
}

Result<TimeSignal> read_channel(const Recording& recording, std::size_t channel) {
  auto stored = read_stored(recording, channel);
  TACTO_TRY(stored);
  const Channel& properties = recording.header.channels[channel];
  TimeSignal signal{recording.header.sample_rate_hz, frame_time_s(recording.header, 0), std::move(*stored)};
  for (double& value : signal.values) value = properties.physical(value);
  const auto broken = std::ranges::find_if(signal.values, [](double value) { return !std::isfinite(value); });
  if (broken == signal.values.end()) return signal;
  return fail(ErrorKind::malformed,
              fmt::format("channel '{}', sample {}: {} is not a finite number", properties.name,
                          broken - signal.values.begin(), *broken),
              wav_path(recording));
}

double frame_time_s(const RecordingHeader& header, std::uint64_t frame) {
  std::uint64_t sequence = frame;
  for (const Gap& gap : header.gaps)
    if (gap.frame <= frame) sequence += gap.count;
  return static_cast<double>(sequence) / header.sample_rate_hz;
}

std::uint64_t frame_at(const RecordingHeader& header, double time_s) {
  std::uint64_t low = 0, high = header.frames;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (frame_time_s(header, middle) < time_s)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

double duration_s(const RecordingHeader& header) {
  return header.frames == 0 ? 0 : frame_time_s(header, header.frames - 1) + 1 / header.sample_rate_hz;
}

}  // namespace tacto::schema

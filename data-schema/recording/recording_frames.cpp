// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/recording_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tacto::schema {
namespace {

constexpr std::size_t kPieceSamples = 32768;  // 256 kB: what stays in the processor's second cache

}  // namespace

RecordingFrames::RecordingFrames(WavReader reader, const Recording& recording)
    : reader_(std::move(reader)),
      channels_(recording.header.channels),
      path_(wav_path(recording)),
      interleaved_(std::max<std::size_t>(kPieceSamples / channels_.size(), 1) * channels_.size()) {}

Result<RecordingFrames> RecordingFrames::open(const Recording& recording) {
  auto reader = WavReader::open(wav_path(recording));
  TACTO_TRY(reader);
  return RecordingFrames(std::move(*reader), recording);
}

tl::unexpected<Error> RecordingFrames::not_finite(std::size_t channel, std::uint64_t frame,
                                                  double value) const {
  return fail(ErrorKind::malformed,
              fmt::format("channel '{}', sample {}: {} is not a finite number", channels_[channel].name,
                          frame, value),
              path_);
}

Result<void> RecordingFrames::read_piece(std::size_t channel, std::uint64_t first, std::span<double> out) {
  const std::size_t channels = channels_.size();
  const auto piece = std::span(interleaved_).first(out.size() * channels);
  const auto got = reader_.read(piece);
  TACTO_TRY(got);
  if (*got < out.size())
    return fail(ErrorKind::malformed, fmt::format("ends at frame {}", first + *got), path_);
  next_ = first + out.size();
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = piece[i * channels + channel];
  const auto broken = std::ranges::find_if(out, [](double value) { return !std::isfinite(value); });
  if (broken == out.end()) return {};
  return not_finite(channel, first + static_cast<std::uint64_t>(broken - out.begin()), *broken);
}

Result<void> RecordingFrames::read_stored(std::size_t channel, std::uint64_t first, std::span<double> out) {
  assert(channel < channels_.size());
  const std::size_t frames = interleaved_.size() / channels_.size();
  if (first != next_)
    if (auto placed = reader_.seek(first); !placed) return placed;
  for (std::size_t begin = 0; begin < out.size(); begin += frames) {
    const std::size_t size = std::min(frames, out.size() - begin);
    if (auto done = read_piece(channel, first + begin, out.subspan(begin, size)); !done) {
      next_ = UINT64_MAX;
      return done;
    }
  }
  return {};
}

Result<void> RecordingFrames::read(std::size_t channel, std::uint64_t first, std::span<double> out) {
  if (auto done = read_stored(channel, first, out); !done) return done;
  const Channel& properties = channels_[channel];
  for (double& value : out) value = properties.physical(value);
  return {};
}

}  // namespace tacto::schema

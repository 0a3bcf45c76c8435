// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <cassert>

#include "data-schema/files/files.hpp"
#include "data-schema/wav/riff_length.hpp"
#include "data-schema/wav/wav.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kPageSamples = 131072;  // 1 MB

// 0 for samples that are not integer codes.
int code_bits(int format) {
  switch (format & SF_FORMAT_SUBMASK) {
    case SF_FORMAT_PCM_S8:
    case SF_FORMAT_PCM_U8:
      return 8;
    case SF_FORMAT_PCM_16:
      return 16;
    case SF_FORMAT_PCM_24:
      return 24;
    case SF_FORMAT_PCM_32:
      return 32;
    default:
      return 0;
  }
}

bool holds_codes(int format) {
  return code_bits(format) > 0;
}

// Only for these formats does the header contain the exact number of frames.
bool holds_plain_samples(int format) {
  const int kind = format & SF_FORMAT_SUBMASK;
  return holds_codes(format) || kind == SF_FORMAT_FLOAT || kind == SF_FORMAT_DOUBLE;
}

std::string name_of(int command, int format) {
  SF_FORMAT_INFO info{};
  info.format = format;
  return sf_command(nullptr, command, &info, sizeof info) == 0 && info.name != nullptr ? info.name
                                                                                       : "unknown";
}

std::string format_words(int format) {
  return name_of(SFC_GET_FORMAT_INFO, format & SF_FORMAT_TYPEMASK) + ", " +
         name_of(SFC_GET_FORMAT_INFO, format & SF_FORMAT_SUBMASK);
}

struct CloseSound {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using OpenSound = std::unique_ptr<SNDFILE, CloseSound>;

WavInfo described(const SF_INFO& header) {
  return {static_cast<double>(header.samplerate),
          static_cast<std::size_t>(header.channels),
          static_cast<std::uint64_t>(std::max<sf_count_t>(header.frames, 0)),
          holds_codes(header.format),
          format_words(header.format),
          code_bits(header.format),
          holds_plain_samples(header.format)};
}

tl::unexpected<Error> truncated(const std::string& path, std::uint64_t promised, std::uint64_t present) {
  return fail(ErrorKind::malformed,
              fmt::format("truncated: its header has {} frames, the file {}", promised, present), path);
}

Result<void> check_length(const std::string& path) {
  const auto length = riff_length(path);
  if (length && length->present_frames < length->promised_frames)
    return truncated(path, length->promised_frames, length->present_frames);
  return {};
}

}  // namespace

struct WavReader::State {
  OpenSound file;
  WavInfo info;
  std::string path;
  std::uint64_t next_frame = 0;

  // The whole frames that fit into `samples`.
  sf_count_t room(std::size_t samples) const {
    assert(samples % info.channels == 0);
    return static_cast<sf_count_t>(samples / info.channels);
  }

  Result<std::size_t> advanced(sf_count_t got, sf_count_t asked) {
    next_frame += static_cast<std::uint64_t>(got);
    if (got < asked && info.plain && next_frame < info.frames)
      return truncated(path, info.frames, next_frame);
    return static_cast<std::size_t>(got);
  }
};

WavReader::WavReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
WavReader::WavReader(WavReader&&) noexcept = default;
WavReader& WavReader::operator=(WavReader&&) noexcept = default;
WavReader::~WavReader() = default;

const WavInfo& WavReader::info() const {
  return state_->info;
}

Result<WavReader> WavReader::open(const std::string& path) {
  TACTO_TRY(check_readable(path));
  TACTO_TRY(check_length(path));
  SF_INFO header{};
  OpenSound file(sf_open(path.c_str(), SFM_READ, &header));
  if (!file)
    return fail(ErrorKind::malformed, fmt::format("not a sound file: {}", sf_strerror(nullptr)), path);
  // Plain codes, not fractions of full scale.
  if (holds_codes(header.format)) sf_command(file.get(), SFC_SET_NORM_DOUBLE, nullptr, SF_FALSE);
  State state{std::move(file), described(header), path, 0};
  return WavReader(std::make_unique<State>(std::move(state)));
}

Result<std::size_t> WavReader::read(std::span<double> interleaved) {
  const sf_count_t asked = state_->room(interleaved.size());
  return state_->advanced(sf_readf_double(state_->file.get(), interleaved.data(), asked), asked);
}

Result<std::size_t> WavReader::read(std::span<std::int32_t> interleaved) {
  if (!state_->info.integer)
    return fail(ErrorKind::unsuitable, "its samples are not integer codes", state_->path);
  const sf_count_t asked = state_->room(interleaved.size());
  return state_->advanced(sf_readf_int(state_->file.get(), interleaved.data(), asked), asked);
}

Result<void> WavReader::seek(std::uint64_t frame) {
  const auto target = static_cast<sf_count_t>(frame);
  if (frame > state_->info.frames || sf_seek(state_->file.get(), target, SEEK_SET) != target)
    return fail(ErrorKind::malformed,
                fmt::format("does not contain frame {}: it ends at {}", frame, state_->info.frames),
                state_->path);
  state_->next_frame = frame;
  return {};
}

Result<std::vector<double>> read_wav_channel(const std::string& path, std::size_t channel) {
  auto reader = WavReader::open(path);
  TACTO_TRY(reader);
  const std::size_t channels = reader->info().channels;
  if (channel >= channels)
    return fail(ErrorKind::unsuitable,
                fmt::format("has {} channels, but no channel {}", channels, channel + 1), path);
  if (!reader->info().plain)
    return fail(ErrorKind::unsuitable, fmt::format("contains {}, not plain samples", reader->info().format),
                path, "import it");
  std::vector<double> piece(std::max<std::size_t>(kPageSamples / channels, 1) * channels);
  std::vector<double> values;
  for (;;) {
    const auto got = reader->read(std::span(piece));
    TACTO_TRY(got);
    if (*got == 0) return values;
    for (std::size_t i = 0; i < *got; ++i) values.push_back(piece[i * channels + channel]);
  }
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <sndfile.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "data-schema/wav/riff_repair.hpp"
#include "data-schema/wav/wav.hpp"

namespace tacto::schema {
namespace {

constexpr double kLargestRate = std::numeric_limits<int>::max();

int subformat(SampleFormat format) {
  if (format == SampleFormat::pcm32) return SF_FORMAT_PCM_32;
  return format == SampleFormat::float32 ? SF_FORMAT_FLOAT : SF_FORMAT_DOUBLE;
}

Result<void> check_rate(double sample_rate_hz, const std::string& path) {
  if (std::round(sample_rate_hz) >= 1 && std::round(sample_rate_hz) <= kLargestRate) return {};
  return fail(ErrorKind::usage, fmt::format("a WAV file cannot store the rate {} per second", sample_rate_hz),
              path);
}

tl::unexpected<Error> unwritten(const std::string& path, SNDFILE* file) {
  return fail(ErrorKind::cannot_write, fmt::format("cannot be written: {}", sf_strerror(file)), path);
}

tl::unexpected<Error> not_opened(const std::string& path, int error_number) {
  if (error_number == EEXIST)
    return fail(ErrorKind::usage, "exists already, and is not overwritten", path, "choose another name");
  return fail(ErrorKind::cannot_write, "cannot be written: " + std::generic_category().message(error_number),
              path);
}

}  // namespace

struct WavWriter::State {
  SNDFILE* file = nullptr;
  std::string path;
  std::size_t channels = 0;
  int header_rate = 0;
  SampleFormat format = SampleFormat::float64;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (file != nullptr) sf_close(file);
  }

  sf_count_t frames(std::size_t samples) const {
    assert(samples % channels == 0);
    return static_cast<sf_count_t>(samples / channels);
  }
  Result<void> written(sf_count_t done, sf_count_t target) const {
    return done == target ? Result<void>{} : unwritten(path, file);
  }
};

WavWriter::WavWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
WavWriter::WavWriter(WavWriter&&) noexcept = default;
WavWriter& WavWriter::operator=(WavWriter&&) noexcept = default;
WavWriter::~WavWriter() = default;

Result<WavWriter> WavWriter::create(const std::string& path, double sample_rate_hz, std::size_t channels,
                                    SampleFormat format) {
  return create(path, O_TRUNC, sample_rate_hz, channels, format);
}

Result<WavWriter> WavWriter::create_new(const std::string& path, double sample_rate_hz, std::size_t channels,
                                        SampleFormat format) {
  auto writer = create(path, O_EXCL, sample_rate_hz, channels, format);
  if (writer) sf_command(writer->state_->file, SFC_UPDATE_HEADER_NOW, nullptr, 0);
  return writer;
}

Result<WavWriter> WavWriter::create(const std::string& path, int flags, double sample_rate_hz,
                                    std::size_t channels, SampleFormat format) {
  TACTO_TRY(check_rate(sample_rate_hz, path));
  SF_INFO header{};
  header.samplerate = static_cast<int>(std::round(sample_rate_hz));
  header.channels = static_cast<int>(channels);
  header.format = SF_FORMAT_RF64 | subformat(format);
  const int opened = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | flags, 0666);
  if (opened < 0) return not_opened(path, errno);
  auto state = std::make_unique<State>();
  state->file = sf_open_fd(opened, SFM_WRITE, &header, SF_TRUE);
  if (state->file == nullptr) {
    ::close(opened);
    return unwritten(path, nullptr);
  }
  state->path = path;
  state->channels = channels;
  state->header_rate = header.samplerate;
  state->format = format;
  // Before the first sample: afterwards libsndfile ignores it. RF64 has no PEAK chunk by default, and in
  // libsndfile 1.2.0 SFC_SET_ADD_PEAK_CHUNK adds one even with the value false, so that command is not used.
  sf_command(state->file, SFC_RF64_AUTO_DOWNGRADE, nullptr, SF_TRUE);
  sf_command(state->file, SFC_SET_UPDATE_HEADER_AUTO, nullptr, SF_TRUE);
  return WavWriter(std::move(state));
}

Result<void> WavWriter::write(std::span<const double> interleaved) {
  assert(state_->format != SampleFormat::pcm32);
  const sf_count_t target = state_->frames(interleaved.size());
  return state_->written(sf_writef_double(state_->file, interleaved.data(), target), target);
}

Result<void> WavWriter::write(std::span<const std::int32_t> interleaved) {
  assert(state_->format == SampleFormat::pcm32);
  const sf_count_t target = state_->frames(interleaved.size());
  return state_->written(sf_writef_int(state_->file, interleaved.data(), target), target);
}

Result<void> WavWriter::close() {
  const int failed = sf_close(std::exchange(state_->file, nullptr));
  if (failed == 0) return {};
  return fail(ErrorKind::cannot_write, fmt::format("cannot be completed: {}", sf_error_number(failed)),
              state_->path);
}

Result<void> WavWriter::close_at(double sample_rate_hz) {
  const std::string path = state_->path;
  if (const auto fits = check_rate(sample_rate_hz, path); !fits) return fits;
  const auto rate = static_cast<std::uint32_t>(std::round(sample_rate_hz));
  const bool same = rate == static_cast<std::uint32_t>(state_->header_rate);
  if (const auto closed = close(); !closed || same) return closed;
  return set_riff_rate(path, rate);
}

}  // namespace tacto::schema

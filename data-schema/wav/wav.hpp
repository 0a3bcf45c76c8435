// SPDX-License-Identifier: GPL-3.0-or-later
// Sample files: the only use of libsndfile. Frames are interleaved; a frame has one sample of every channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// How a WAV of tactograph stores its samples. pcm32 holds converter codes, float64 imported numbers, float32
/// textures.
enum class SampleFormat { pcm32, float32, float64 };

/// The header of a sample file.
struct WavInfo {
  double sample_rate_hz = 0;
  std::size_t channels = 0;
  std::uint64_t frames = 0;
  bool integer = false;  ///< samples are integer PCM
  std::string format;    ///< in libsndfile's words
  int code_bits = 0;     ///< width of the codes, where `integer`
  bool plain = false;    ///< samples are stored uncompressed, in that many bits
};

/// Reads any sound file that libsndfile knows. Not safe in the tick.
class WavReader {
 public:
  /// Errors: not_found (absent, a folder, unreadable); malformed (not a sound file; truncated: a WAV that is
  /// shorter than its header says).
  static Result<WavReader> open(const std::string& path);
  WavReader(WavReader&&) noexcept;
  WavReader& operator=(WavReader&&) noexcept;
  ~WavReader();

  const WavInfo& info() const;
  /// Fills whole frames from the current place; returns the number of frames read, 0 at the end. Integer
  /// samples are plain codes of their own width (16 bit: -32768 ... 32767, no scaling to +-1), float samples
  /// are unchanged. Errors: malformed, if the file ends early.
  Result<std::size_t> read(std::span<double> interleaved);
  /// The same as 32-bit codes: those of a 32-bit file as they are, narrower ones left-justified. Errors: also
  /// unsuitable, where the samples are no integers.
  Result<std::size_t> read(std::span<std::int32_t> interleaved);
  /// Goes to a frame. Errors: malformed, where the file ends before it.
  Result<void> seek(std::uint64_t frame);

 private:
  struct State;
  explicit WavReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a WAV: RF64 that becomes plain WAV under 4 GB, its header updated as it grows, no PEAK chunk (it
/// would contain the time of day, and equal inputs would not give equal files). Not safe in the tick.
class WavWriter {
 public:
  /// Errors: cannot_write; usage, for a rate that no header can hold (it must round to 1 ... 2^31-1).
  static Result<WavWriter> create(const std::string& path, double sample_rate_hz, std::size_t channels,
                                  SampleFormat format);
  /// The same, but never replaces a file, and with the header on disk from the start. Errors: also usage, if
  /// the file exists.
  static Result<WavWriter> create_new(const std::string& path, double sample_rate_hz, std::size_t channels,
                                      SampleFormat format);
  WavWriter(WavWriter&&) noexcept;
  WavWriter& operator=(WavWriter&&) noexcept;
  ~WavWriter();

  /// Appends whole frames. `double` is for float formats, codes are for pcm32. Errors: cannot_write (disk
  /// full ...).
  Result<void> write(std::span<const double> interleaved);
  Result<void> write(std::span<const std::int32_t> interleaved);
  /// Ends the file. Errors: cannot_write. Without this call the destructor closes it, and failures are not
  /// reported.
  Result<void> close();
  /// The same, with another rate in the header than it had until now. Errors: also usage, as create().
  Result<void> close_at(double sample_rate_hz);

 private:
  struct State;
  static Result<WavWriter> create(const std::string& path, int flags, double sample_rate_hz,
                                  std::size_t channels, SampleFormat format);
  explicit WavWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A whole file's samples of one channel (0-based).
Result<std::vector<double>> read_wav_channel(const std::string& path, std::size_t channel);

}  // namespace tacto::schema

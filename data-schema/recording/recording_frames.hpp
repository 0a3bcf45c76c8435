// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a recording in parts, so that one of any length needs little memory.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// Frames of a recording from any place. Not shared between threads. Not safe in the tick.
class RecordingFrames {
 public:
  /// Errors: as of WavReader::open.
  static Result<RecordingFrames> open(const Recording& recording);

  /// The stored numbers of one channel from frame `first` on, as many as `out` has. Precondition: there are
  /// such frames and such a channel. Errors: malformed, where the file ends early, and, with the sample,
  /// where a value is NaN or infinite.
  Result<void> read_stored(std::size_t channel, std::uint64_t first, std::span<double> out);
  /// The same in SI units: stored * scale + offset.
  Result<void> read(std::size_t channel, std::uint64_t first, std::span<double> out);

 private:
  RecordingFrames(WavReader reader, const Recording& recording);
  Result<void> read_piece(std::size_t channel, std::uint64_t first, std::span<double> out);
  tl::unexpected<Error> not_finite(std::size_t channel, std::uint64_t frame, double value) const;

  WavReader reader_;
  std::vector<Channel> channels_;
  std::string path_;
  std::vector<double> interleaved_;
  std::uint64_t next_ = 0;  // the frame at the file's read position
};

}  // namespace tacto::schema

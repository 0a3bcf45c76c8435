// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings of the Lab Streaming Layer (.xdf).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// At `time_s` of the stream's clock, the recorder's clock was `ahead_s` ahead of it.
struct XdfClockOffset {
  double time_s = 0, ahead_s = 0;
};

struct XdfStream {
  std::uint32_t id = 0;
  std::string name, type, format;  ///< "Force", "Haptics", "float32"
  std::size_t channels = 0;
  double nominal_rate_hz = 0;              ///< 0: samples come at any time
  std::vector<std::string> labels, units;  ///< of the channels; "ch1" ... and "" where the header has none
  std::uint64_t samples = 0;               ///< in the whole chunks
  std::optional<std::uint64_t> stated_samples;  ///< by its footer, the last chunk of a stream
  std::vector<XdfClockOffset> clock_offsets;
  std::string refusal;  ///< why its samples are not read as numbers: "is text ..."; empty if they are

  bool is_text() const { return format == "string" && channels > 0; }  ///< as read_xdf_markers() reads it
};

/// A sample of a stream of text.
struct XdfMarker {
  double time_s = 0;  ///< by the stream's clock
  std::string label;  ///< of several channels with blanks between; bytes as in the file (XDF: UTF-8)
};

struct XdfContents {
  std::vector<XdfStream> streams;
  std::string cut;  ///< where the file ends inside a chunk; empty if its last chunk is whole
};

/// The most channels of a stream, and the most memory of its markers.
inline constexpr std::size_t kMostXdfChannels = 4096;
inline constexpr std::size_t kMostXdfMarkerBytes = std::size_t{64} << 20;

bool is_xdf(std::string_view beginning);

/// The streams of a file, without their numbers. Format: sccn/xdf, "Specifications", version 1.0; chunks of
/// unknown types are skipped. A file that was cut is read up to its last whole chunk. Sizes are compared with
/// the file's length before memory is allocated. Errors: not_found; malformed, with chunk and byte;
/// unsuitable, for another version. A stream with an odd header only has a refusal.
Result<XdfContents> xdf_contents(const std::string& path);

/// Receives consecutive samples: their times by the stream's clock, and the numbers of the chosen channels,
/// sample by sample.
using XdfHandler =
    std::function<Result<void>(std::span<const double> times_s, std::span<const double> numbers)>;

/// Reads these channels (from 0) of a stream of xdf_contents(), every number exactly. The time of a sample
/// that has none is whole nominal periods after the last stated one. `progress` receives 0 to 1. Errors: as
/// xdf_contents(); those of `take`; malformed, for a missing time; unsuitable, for an integer beyond 2^53,
/// which has no exact double. Memory: 1 MiB, for a file of any length.
Result<void> read_xdf(const std::string& path, const XdfStream& stream, std::span<const std::size_t> channels,
                      const XdfHandler& take, const std::function<void(double)>& progress);

/// The samples of a stream of text of xdf_contents(), in their order; times as of read_xdf(). Errors: as
/// xdf_contents(); malformed, for a missing time; unsuitable, above kMostXdfMarkerBytes.
/// Precondition: stream.is_text().
Result<std::vector<XdfMarker>> read_xdf_markers(const std::string& path, const XdfStream& stream);

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// Import of another program's file as a recording: unchanged numbers, and a sidecar with their meaning.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// The user's request. SI units; texts in the form of parse_channel() and parse_scaled_column().
struct ImportRequest {
  std::string file;
  std::string name;                   ///< of the recording, with or without extension
  bool replace = false;               ///< whether an existing recording of that name is replaced
  std::vector<std::string> channels;  ///< may be empty for mono audio: one `signal`
  std::optional<double> rate_hz;      ///< of a table; of audio, if its header is wrong
  std::size_t skip_lines = 0;         ///< of a table: lines before its header or first row
  std::string time_column;            ///< instead of rate_hz, "time_s*1s"
  std::string stream = {};            ///< of an XDF file: a name or number
  std::optional<std::uint64_t> row = std::nullopt, column = std::nullopt;  ///< of an X3P surface, from 1
  std::string points = {};                                                 ///< of its line, "121..480"
  std::optional<double> pitch_m;                       ///< of a height profile or map, see height_profile.hpp
  std::optional<double> full_height_m = std::nullopt;  ///< of a PNG: the height of white; black is 0
  bool allow_8bit = false;                             ///< of a PNG: also fewer than 16 bits
  std::optional<double> unit_m = std::nullopt;         ///< of a mesh
  bool repair = false;  ///< of a mesh: drop triangles without an area, merge vertices, turn flipped ones
  bool open = false;    ///< of a mesh: keep its holes
  std::optional<double> speed_mps;   ///< results in a nominal position
  bool integrate_speed = true;       ///< compute a position from a speed channel if none was measured
  bool mask_outliers = false;        ///< rows with outliers are left out and become gaps
  std::string recorded, calibrated;  ///< ISO dates, "2026-03-14"
  std::string subject, finger, surface, notes;
  std::optional<double> humidity_percent;
};

/// Smallest and largest physical value of a channel.
struct ChannelRange {
  double smallest = 0, largest = 0;
};

struct Imported {
  schema::Recording recording;  ///< header.warnings lists what is probably wrong
  std::vector<ChannelRange> ranges;
  std::string format;          ///< of the source, for messages
  std::uint64_t outliers = 0;  ///< samples out of range or isolated; a row may have several
  std::uint64_t masked_rows = 0;
};

/// Imports a file. All checks that do not need the whole file are done first. Stored numbers are exactly
/// those of the source (float64); scale and offset are written to the sidecar. A derived position is stored
/// in metres, after the other channels. `progress` receives 0 to 1. Errors: usage (options that contradict
/// the file or each other, an existing recording), not_found, malformed (with line and column), unsuitable
/// (our own files, too many outliers to mask), cannot_write. After an error no file remains. The file is read
/// once; twice if gaps or isolated samples have to be named by their line, or if a position is derived from a
/// speed and a time column; three times to mask outliers. Memory: some blocks and 256 KB per channel, for
/// files of any length. Not safe in the tick.
schema::Result<Imported> import_file(const ImportRequest& request,
                                     const std::function<void(double)>& progress);

}  // namespace tacto::capture

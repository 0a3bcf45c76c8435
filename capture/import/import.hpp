// SPDX-License-Identifier: GPL-3.0-or-later
// Another program's file made a recording: its numbers as they were, what they mean beside them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// What the user asks for. SI units; texts as parse_channel() and parse_scaled_column() read them.
struct ImportRequest {
  std::string file;
  std::string name;                   ///< of the recording, with or without extension
  bool replace = false;               ///< an existing recording of that name
  std::vector<std::string> channels;  ///< may be empty for mono audio: one `signal`
  std::optional<double> rate_hz;      ///< of a table; of audio, where its header is wrong
  std::size_t skip_lines = 0;         ///< of a table: its header, or first row, follows them
  std::string time_column;            ///< instead of rate_hz, "time_s*1s"
  std::optional<double> pitch_m;      ///< of a height profile: see height_profile.hpp
  std::optional<double> speed_mps;    ///< makes a nominal position
  bool integrate_speed = true;        ///< a speed channel gives a position, where none was measured
  bool mask_outliers = false;         ///< rows with outliers are left out and become gaps
  std::string recorded, calibrated;   ///< ISO dates, "2026-03-14"
  std::string subject, finger, surface, notes;
  std::optional<double> humidity_percent;
};

/// Smallest and largest physical value of a channel.
struct ChannelRange {
  double smallest = 0, largest = 0;
};

struct Imported {
  schema::Recording recording;  ///< header.warnings says what looks wrong
  std::vector<ChannelRange> ranges;
  std::string format;          ///< of the source, for people
  std::uint64_t outliers = 0;  ///< samples that are beyond or alone; a row may have several
  std::uint64_t masked_rows = 0;
};

/// Imports. Everything that can be checked without reading all of the file is checked first. Stored numbers
/// are exactly the source's (float64), scale and offset go to the sidecar; a derived position is stored in
/// metres, after them. `progress` takes 0 to 1. Errors: usage (options that don't fit the file or each other,
/// a recording there already), not_found, malformed (with line and column), unsuitable (files of our own, too
/// many outliers to mask), cannot_write. Nothing is left behind after one. The file is read once, or twice
/// where something in it has to be named by its line (gaps, lone samples) or where a position is made of a
/// speed and a time column; three times to mask outliers. Memory: some blocks and 256 KB a channel, whatever
/// the file's length. Not safe in the tick.
schema::Result<Imported> import_file(const ImportRequest& request,
                                     const std::function<void(double)>& progress);

}  // namespace tacto::capture

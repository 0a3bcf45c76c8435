// SPDX-License-Identifier: GPL-3.0-or-later
// Another program's file, whatever its format: columns of numbers, opened first, read later.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/csv_layout.hpp"
#include "capture/csv_reader.hpp"
#include "data-schema/error.hpp"

namespace tacto::capture {

/// What a file holds, as its first lines or its header say.
struct Source {
  std::string file;
  std::vector<std::string> columns;  ///< names, empty where a column has none; audio: "ch1", "ch2" ...
  std::optional<CsvLayout> csv;      ///< of a table; without it the file is audio
  std::optional<double> rate_hz;     ///< of audio
  int code_bits = 0;                 ///< of audio that holds integer codes
  std::string format;                ///< for people: "table, comma", "WAV (Microsoft), Signed 16 bit PCM"
};

/// The numbers of the columns that were asked for, exactly as the file has them (integer audio: its codes).
struct SourceData {
  std::vector<std::vector<double>> columns;
  std::vector<CsvReader::Landmark> landmarks;  ///< of a table

  /// "line 4229" of a table, "sample 4228" of audio, for messages.
  std::string place_of(std::size_t row) const;
};

/// Looks into a file: audio where libsndfile reads it, else a table. Errors: not_found; malformed, for what
/// is neither; unsuitable, for files of tactograph's own.
schema::Result<Source> open_source(const std::string& file);

/// Reads columns (0-based, each once). `progress` takes 0 to 1. Errors: not_found; malformed, with line and
/// column or sample, at the first number that can't be kept. Memory: 8 bytes a number.
schema::Result<SourceData> read_source(const Source& source, std::span<const std::size_t> columns,
                                       const std::function<void(double)>& progress);

/// "1 'lateral_V', 2 'normal_V'", for messages.
std::string columns_in_words(const std::vector<std::string>& columns);

}  // namespace tacto::capture

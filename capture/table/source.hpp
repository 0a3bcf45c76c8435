// SPDX-License-Identifier: GPL-3.0-or-later
// Another program's file, whatever its format: columns of numbers, opened first, read later.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/table/csv_layout.hpp"
#include "capture/table/csv_reader.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/base/sha256.hpp"

namespace tacto::capture {

/// What a file holds, as its first lines or its header say.
struct Source {
  std::string file;
  std::vector<std::string> columns;     ///< names, empty where a column has none; audio: "ch1", "ch2" ...
  std::optional<CsvLayout> csv;         ///< of a table; without it the file is audio
  std::optional<double> rate_hz;        ///< of audio
  int code_bits = 0;                    ///< of audio that holds integer codes
  std::string format;                   ///< for people: "table, comma", "WAV (Microsoft), Signed 16 bit PCM"
  std::vector<std::string> units = {};  ///< of a table's columns, as it writes them; empty where it has none
};

/// A stretch of a source's rows: the numbers of the columns that were asked for, exactly as the file has them
/// (integer audio: its codes), row by row.
struct RowBlock {
  std::span<const double> numbers;
  std::size_t columns = 0;
  std::uint64_t first_row = 0;
  const std::deque<CsvReader::Landmark>* landmarks = nullptr;  ///< of a table
  char decimal_mark = 0;  ///< of a table: '.', ',', or 0 where no number had one so far

  std::size_t rows() const { return numbers.size() / columns; }
  /// "line 4229" of a table, "sample 4228" of audio, for messages. `row` counts from the file's first; it is
  /// one of these or of the CsvReader::kRowsRemembered before.
  std::string place_of(std::uint64_t row) const;
};

using TakeRows = std::function<schema::Result<void>(const RowBlock&)>;

/// Looks into a file: audio where libsndfile reads it, else a table that begins after `skip` lines. Errors:
/// not_found; malformed, for what is neither; unsuitable, for files of tactograph's own and for those of
/// other kinds that are known (foreign_format); usage, where sound has lines to skip.
schema::Result<Source> open_source(const std::string& file, std::size_t skip = 0);

/// Reads columns (0-based, each once) block by block; `sum`, where given, is fed the file's bytes on the way.
/// `progress` takes 0 to 1. Errors: those of `take`; not_found; malformed, with line and column or sample, at
/// the first number that can't be kept. Memory: one block, whatever the file's length.
schema::Result<void> read_source(const Source& source, std::span<const std::size_t> columns,
                                 const TakeRows& take, const std::function<void(double)>& progress,
                                 schema::Sha256* sum = nullptr);

/// "1 'lateral_V', 2 'normal_V'", for messages.
std::string columns_in_words(const std::vector<std::string>& columns);

}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
// Another program's file of any known format, as columns of numbers: opened first, read later.
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
#include "data-schema/exchange/mat_file.hpp"
#include "data-schema/exchange/xdf_file.hpp"

namespace tacto::capture {

/// The contents of a file, from its first lines or its header.
struct Source {
  std::string file;
  std::vector<std::string> columns;  ///< names, empty for a column without one; audio: "ch1", "ch2" ...
  std::optional<CsvLayout> csv;      ///< of a table
  std::optional<double> rate_hz;     ///< of audio
  int code_bits = 0;                 ///< of audio that holds integer codes
  std::string format;                ///< for messages: "table, comma", "WAV (Microsoft), Signed 16 bit PCM"
  std::vector<std::string> units = {};  ///< of a table's columns, as it writes them; empty if it has none
  std::optional<schema::MatContents> mat =
      std::nullopt;             ///< of a MATLAB file; without csv, mat and xdf it is audio
  bool unknown_as_nan = false;  ///< of a MATLAB file or a stream: NaN is passed on, not refused
  std::optional<schema::XdfContents> xdf = std::nullopt;       ///< of a recording of the Lab Streaming Layer
  std::optional<schema::XdfStream> xdf_stream = std::nullopt;  ///< of its streams the one that is read
};

/// Consecutive rows of a source: the numbers of the selected columns, exactly as in the file (integer audio:
/// its codes), row by row.
struct RowBlock {
  std::span<const double> numbers;
  std::size_t columns = 0;
  std::uint64_t first_row = 0;
  const std::deque<CsvReader::Landmark>* landmarks = nullptr;  ///< of a table
  char decimal_mark = 0;  ///< of a table: '.', ',', or 0 if no number has had one so far

  std::size_t rows() const { return numbers.size() / columns; }
  /// "line 4229" of a table, "sample 4228" of audio, for messages. `row` is counted from the first row of the
  /// file; it is one of this block or of the CsvReader::kRowsRemembered rows before it.
  std::string place_of(std::uint64_t row) const;
};

using RowHandler = std::function<schema::Result<void>(const RowBlock&)>;

/// Opens a file: a MATLAB or XDF file, audio if libsndfile can read it, otherwise a table that begins after
/// `skip` lines. `stream` is a name or number in an XDF file; without it the only stream of numbers is taken,
/// and none of several. Errors: not_found; malformed, if it is none of them, or a MATLAB file that was cut;
/// unsuitable, for files of tactograph itself, for other known kinds (foreign_format) and for a stream of
/// text; usage, if lines are to be skipped in a file without lines, or a stream does not exist.
schema::Result<Source> open_source(const std::string& file, std::size_t skip = 0,
                                   const std::string& stream = {});

/// Reads columns (0-based, without duplicates) block by block; `sum`, if given, receives the bytes of the
/// file. `progress` receives 0 to 1. Errors: those of `take`; not_found; malformed, with line and column or
/// sample, at the first number that is refused; unsuitable, for columns of a MATLAB file of different
/// lengths. Memory: one block, for a file of any length; of a MATLAB file the variables, at most
/// schema::kMostMatBytes.
schema::Result<void> read_source(const Source& source, std::span<const std::size_t> columns,
                                 const RowHandler& take, const std::function<void(double)>& progress,
                                 schema::Sha256* sum = nullptr);

/// "1 'lateral_V', 2 'normal_V'", for messages.
std::string columns_in_words(const std::vector<std::string>& columns);

}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the numbers of selected columns of a table, piece by piece.
#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/table/csv_layout.hpp"
#include "capture/table/csv_number.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// Memory for numbers, of which `count` are used. A vector would first set them to zero.
struct NumberStore {
  std::unique_ptr<double[]> numbers;
  std::size_t count = 0, room = 0;

  std::span<const double> span() const { return {numbers.get(), count}; }
};

/// Accepts the bytes of a table in pieces of any size and returns the numbers of the chosen columns, row by
/// row. It does no input or output: the result depends on the bytes alone, not on how they are divided. The
/// other columns may contain anything, but every row must have all columns. Comment lines are skipped; blank
/// lines are permitted only before the first row and after the last. Memory: the rows that were not dropped,
/// and the longest line. Not safe in the tick.
class CsvReader {
 public:
  /// `columns`: 0-based, without duplicates, less than the number of layout.columns. `file` is for messages.
  CsvReader(CsvLayout layout, const std::vector<std::size_t>& columns, std::string file);

  /// The next bytes from layout.data_offset on. Errors: malformed, with line and column: a row with another
  /// number of fields, text in a number, NaN, Inf, a missing value (unless layout.unknown_as_nan), a number
  /// out of the range of double, mixed decimal marks, a blank line between rows. After an error the reader
  /// cannot be used any more.
  schema::Result<void> feed(std::string_view piece);
  /// The end of the file: its last line may lack a line end. Errors: as feed(); malformed, if there is no
  /// row.
  schema::Result<void> finish();

  /// The complete rows since drop_rows(), each with its numbers in the order of `columns`.
  std::span<const double> rows() const { return store_.span(); }
  std::size_t first_row() const { return dropped_; }  ///< the row of the table at the start of rows()
  void drop_rows();
  /// As drop_rows(), but the caller gets the rows, and gives room for new ones: an empty store.
  void exchange_rows(NumberStore& store);

  /// The number of rows before first_row() whose line is still known.
  static constexpr std::size_t kRowsRemembered = 4;
  /// The line in the file, from 1, of each row that is not on the line after the previous row.
  struct Landmark {
    std::size_t row = 0;
    std::size_t line = 0;
  };
  const std::deque<Landmark>& landmarks() const { return landmarks_; }

  /// The decimal mark of the numbers: '.', ',', or 0 if there was none.
  char decimal_mark() const { return decimal_mark_; }

 private:
  bool take_lines(std::string_view& bytes);
  bool take_line(std::string_view line);
  bool take_row(std::string_view line);
  bool take_number(std::string_view line, std::size_t& at, std::size_t column);
  bool take_plain_number(std::string_view line, std::size_t& at, double& value);
  bool refuse_number(NumberFault fault, std::string_view line, std::string_view field, std::size_t column);
  bool refuse_ragged(std::string_view line);
  bool refuse_blank();
  bool refuse(std::string what, std::string remedy, std::optional<std::size_t> column = std::nullopt);
  void make_room(std::size_t numbers);
  void note_row();

  CsvLayout layout_;
  std::string file_;
  static constexpr std::size_t kSkipped = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> places_;  // of each column of the file: its place in a row, or kSkipped
  std::size_t kept_;                 // numbers of a row
  NumberStore store_;                // rows()
  std::deque<Landmark> landmarks_;
  std::string incomplete_line_;  // an incomplete line
  std::size_t line_;             // number of the next line
  std::size_t rows_ = 0, dropped_ = 0;
  std::size_t blank_line_ = 0;  // the first blank line since the last row, 0 for none
  char decimal_mark_ = 0;
  std::optional<schema::Error> error_;
};

/// The line of a row, from 1.
std::size_t line_of_row(const std::deque<CsvReader::Landmark>& landmarks, std::size_t row);

/// "column 2 ('force')", or without the name if it has none. `column` is 0-based.
std::string column_in_words(const std::vector<std::string>& names, std::size_t column);

}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of bare numbers, quickly and exactly: what most of a table is.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace tacto::capture {

/// How the rows of a table are written.
struct RowForm {
  /// Of a column that is passed over.
  static constexpr std::size_t kSkipped = static_cast<std::size_t>(-1);

  char delimiter = ',';
  char line_end = '\n';
  char mark = '.';                           ///< the decimal mark; not the delimiter
  std::span<const std::size_t> places = {};  ///< of each column: its number's place in the row, or kSkipped
  std::size_t kept = 0;                      ///< numbers of a row
};

struct PlainRows {
  std::size_t bytes = 0;  ///< that were read: whole rows, line ends included
  std::size_t rows = 0;
  bool marked = false;  ///< one of the numbers has a decimal mark
};

/// Reads whole rows from the beginning of `bytes` for as long as they are plain: numbers right up to their
/// delimiters, without blanks, quotes or plus signs; columns that are passed over hold no quotes. Writes
/// form.kept numbers a row to `numbers`, which has room for bytes.size() / 2 of them. It stops at the first
/// row that is anything else, and some bytes before the end: what is left is for a slower reader, which also
/// says what is wrong.
///
/// Ends of fields are found 64 bytes at a time, so that reading a number needn't wait for the one before.
/// Numbers of up to 15 digits are read 16 bytes at once and divided once by a power of ten, exact as
/// read_plain_decimal() is; others by std::from_chars. On processors without SSE 4.1 it reads
/// nothing. Pure.
PlainRows read_plain_rows(std::string_view bytes, const RowForm& form, double* numbers);

}  // namespace tacto::capture

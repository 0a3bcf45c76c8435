// SPDX-License-Identifier: GPL-3.0-or-later
// Fast and exact reading of rows of plain numbers, which are most of a table.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace tacto::capture {

/// The notation of the rows of a table.
struct RowForm {
  /// The place of a column that is not read.
  static constexpr std::size_t kSkipped = static_cast<std::size_t>(-1);

  char delimiter = ',';
  char line_end = '\n';
  char mark = '.';                           ///< the decimal mark; not the delimiter
  std::span<const std::size_t> places = {};  ///< of each column: its index in the row, or kSkipped
  std::size_t kept = 0;                      ///< the numbers per row
};

struct PlainRows {
  std::size_t bytes = 0;  ///< the bytes that were read: whole rows with their line ends
  std::size_t rows = 0;
  bool marked = false;  ///< one of the numbers has a decimal mark
};

/// Reads whole rows from the beginning of `bytes` while they are plain: numbers directly before their
/// delimiters, without blanks, quotes or plus signs; skipped columns contain no quotes. Writes form.kept
/// numbers per row to `numbers`, which has room for bytes.size() / 2 of them. It stops at the first row that
/// is not plain, and some bytes before the end. The rest is for a slower reader, which also reports errors.
///
/// Ends of fields are found 64 bytes at a time, so that numbers can be read independently of each other.
/// Numbers of up to 15 digits are read 16 bytes at once and divided once by a power of ten, as exact as
/// read_plain_decimal(); others by std::from_chars. On processors without SSE 4.1 nothing is read. Pure.
PlainRows read_plain_rows(std::string_view bytes, const RowForm& form, double* numbers);

}  // namespace tacto::capture

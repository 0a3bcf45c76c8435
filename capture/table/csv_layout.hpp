// SPDX-License-Identifier: GPL-3.0-or-later
// How a table of another program is laid out, found from its first lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// What the first lines of a file told about all of it.
struct CsvLayout {
  char delimiter = ',';              ///< comma, semicolon or tab
  char line_end = '\n';              ///< '\r' in files of very old programs; "\r\n" counts as '\n'
  std::vector<std::string> columns;  ///< header names in UTF-8; empty strings where there is no name
  std::vector<std::string> units;    ///< of each column, from its name or a row of units; empty where unknown
  bool header = false;
  std::size_t header_line = 0, units_line = 0;  ///< from 1; 0 where there is none
  std::size_t lines_before = 0;                 ///< that hold no part of the table: titles, settings
  std::size_t data_offset =
      0;                      ///< where the first line after the header (or byte-order mark) begins, in bytes
  std::size_t data_line = 1;  ///< and which line of the file that is, from 1
};

/// Bytes of a file that are enough to find its layout.
inline constexpr std::size_t kLayoutBytes = std::size_t{1} << 18;

/// Finds the layout from the first kLayoutBytes of a file, or all of it where it is shorter (`whole`).
/// The first line that is neither blank nor a comment is a header where most of its fields are no numbers.
/// Where no rows follow it, the table begins later: see find_table_start(). `skip` lines are not looked at,
/// and the table begins right after them. Pure: `file` is only for messages. Errors: malformed, for an empty
/// file, a header without data, a first line that mixes names and numbers, UTF-16, zero bytes; usage, where
/// there are no more lines than those to skip.
schema::Result<CsvLayout> find_csv_layout(std::string_view head, bool whole, const std::string& file,
                                          std::size_t skip = 0);

}  // namespace tacto::capture

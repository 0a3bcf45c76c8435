// SPDX-License-Identifier: GPL-3.0-or-later
// The layout of another program's table, found from its first lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// The properties of a file that its first lines show.
struct CsvLayout {
  char delimiter = ',';              ///< comma, semicolon or tab
  char line_end = '\n';              ///< '\r' in files of very old programs; "\r\n" is treated as '\n'
  std::vector<std::string> columns;  ///< header names in UTF-8; empty for a column without a name
  std::vector<std::string> units;    ///< of each column, from its name or a row of units; empty if unknown
  bool header = false;
  std::size_t header_line = 0, units_line = 0;  ///< from 1; 0 if there is none
  std::size_t lines_before = 0;                 ///< that do not belong to the table: titles, settings
  std::size_t data_offset =
      0;  ///< the offset of the first line after the header (or byte-order mark), in bytes
  std::size_t data_line = 1;    ///< the number of that line in the file, from 1
  bool unknown_as_nan = false;  ///< a missing, NaN or infinite number is read as NaN; otherwise it is refused
  std::string unknown_remedy =
      "unknown values are not filled in: leave out their rows";  ///< when it is refused
};

/// The part of a file that is sufficient to find its layout.
inline constexpr std::size_t kLayoutBytes = std::size_t{1} << 18;

/// Finds the layout from the first kLayoutBytes of a file, or all of it if it is shorter (`whole`). The first
/// line that is neither blank nor a comment is a header if most of its fields are not numbers. If no rows
/// follow it, the table begins later: see find_table_start(). The first `skip` lines are ignored, and the
/// table begins directly after them. Pure: `file` is only for messages. Errors: malformed, for an empty file,
/// a header without data, a first line that mixes names and numbers, UTF-16, zero bytes; usage, if the file
/// does not have more than `skip` lines.
schema::Result<CsvLayout> find_csv_layout(std::string_view head, bool whole, const std::string& file,
                                          std::size_t skip = 0);

}  // namespace tacto::capture

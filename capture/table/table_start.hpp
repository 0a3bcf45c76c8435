// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the beginning of a table in a file whose first lines are titles, settings, names, units.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tacto::capture {

/// A line that is neither blank nor a comment.
struct TableLine {
  std::string_view text;
  std::size_t number = 0;  ///< 1-based, of the file
  std::size_t begin = 0;   ///< its offset
  std::size_t next = 0;    ///< offset of the line after it
};

struct TableStart {
  char delimiter = ',';
  std::size_t first_row = 0;  ///< index among the lines, as in the next members
  std::optional<std::size_t> names, units;
  std::size_t columns = 0;
  std::size_t least_names = 0;  ///< one less if the rows end with a delimiter
};

/// Finds the first five consecutive rows of numbers with the same number of fields (fewer if the lines end
/// before), and the lines of names and of units directly before them. If no rows consist of numbers alone,
/// some columns may be text. A row with an error directly before them belongs to the table: it is refused
/// later and not skipped. nullopt if there are no such rows, if lines before them are such rows too, or if
/// the line before them has several fields that are neither names nor units.
std::optional<TableStart> find_table_start(std::span<const TableLine> lines);

/// The fields as column names: a surplus field is dropped if it is empty or "Comment", as LabVIEW writes it.
/// nullopt if there are too many or too few.
std::optional<std::vector<std::string>> names_for(std::vector<std::string> fields, const TableStart& start);

/// Whether two lines have the same number of fields, and text in the same fields.
bool has_text_where(const std::vector<std::string>& a, const std::vector<std::string>& b);

std::vector<std::string> fields_in(const TableLine& line, char delimiter);

}  // namespace tacto::capture

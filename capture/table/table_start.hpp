// SPDX-License-Identifier: GPL-3.0-or-later
// Where a table begins in a file whose first lines are something else: titles, settings, names, units.
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
  std::size_t first_row = 0;  ///< of the lines, as what follows
  std::optional<std::size_t> names, units;
  std::size_t columns = 0;
  std::size_t least_names = 0;  ///< one less where the rows end with a delimiter
};

/// The first five rows of numbers that follow each other and have equally many fields (less where the lines
/// end before), and the lines of names and of units right before them. Where no rows are numbers alone, some
/// columns may be text. A row with a mistake in it, right before them, is one of them: it is refused later,
/// never passed over. nullopt where there are no such rows, where lines further up are such rows too, or
/// where the line before them has several fields that are neither their names nor units.
std::optional<TableStart> find_table_start(std::span<const TableLine> lines);

/// The fields as names of the columns: a surplus field is left out where it is empty or "Comment",
/// as LabVIEW writes it. nullopt where there are too many or too few.
std::optional<std::vector<std::string>> names_for(std::vector<std::string> fields, const TableStart& start);

/// Whether two lines have text in the same fields, and equally many of them.
bool has_text_where(const std::vector<std::string>& a, const std::vector<std::string>& b);

std::vector<std::string> fields_in(const TableLine& line, char delimiter);

}  // namespace tacto::capture

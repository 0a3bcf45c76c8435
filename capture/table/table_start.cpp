// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/table_start.hpp"

#include <algorithm>

#include "capture/table/csv_fields.hpp"
#include "capture/table/csv_number.hpp"
#include "capture/table/text_encoding.hpp"
#include "data-schema/base/column_unit.hpp"

namespace tacto::capture {
namespace {

using Fields = std::vector<std::string>;

constexpr std::size_t kRowsToTrust = 5;  // one or two lines of settings may be only numbers

struct FieldCounts {
  std::size_t names = 0, numbers = 0;
};

FieldCounts count_fields(const Fields& fields) {
  FieldCounts counts;
  for (const std::string& field : fields) {
    if (is_name(field)) ++counts.names;
    if (is_numeric(field)) ++counts.numbers;
  }
  return counts;
}

enum class Rows { numbers_alone, with_text };

bool is_row(const Fields& fields, Rows kind) {
  const auto [names, numbers] = count_fields(fields);
  return numbers > 0 && (names == 0 || kind == Rows::with_text);
}

bool is_half_numbers(const Fields& fields) {
  const auto [names, numbers] = count_fields(fields);
  return numbers > 0 && numbers >= names;
}

// A row of a table may contain text, so a line of names must contain no number.
bool is_names_alone(const Fields& fields) {
  const auto [names, numbers] = count_fields(fields);
  return names > 0 && numbers == 0;
}

// The unit of a plain number is "1", which is also a number.
bool is_units_row(const Fields& fields) {
  const auto no_unit = [](const std::string& field) { return is_numeric(field) && field != "1"; };
  return std::ranges::none_of(fields, no_unit) && std::ranges::any_of(fields, schema::is_known_unit) &&
         std::ranges::count_if(fields, schema::may_be_unit) * 2 > std::ranges::ssize(fields);
}

// The number of rows of the same form from line `first` on, at most kRowsToTrust.
std::size_t rows_from(std::span<const TableLine> lines, std::size_t first, char delimiter, Rows kind) {
  Fields like;
  std::size_t rows = 0;
  for (; first + rows < lines.size() && rows < kRowsToTrust; ++rows) {
    Fields fields = fields_in(lines[first + rows], delimiter);
    if (rows == 0) like = fields;
    if (!is_row(fields, kind) || !has_text_where(fields, like)) return rows;
  }
  return rows;
}

// The first line from which kRowsToTrust rows follow, or fewer if the lines end before. A single row with a
// single column is not sufficient: it may be any number.
std::optional<std::size_t> first_row_with(std::span<const TableLine> lines, char delimiter, Rows kind) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t rows = rows_from(lines, i, delimiter, kind);
    const bool wide = field_count(lines[i].text, delimiter) > 1;
    if (rows == kRowsToTrust || (rows > 0 && i + rows == lines.size() && (wide || rows > 1))) return i;
  }
  return std::nullopt;
}

// The first row with the delimiter that gives the most columns.
std::optional<TableStart> widest_rows(std::span<const TableLine> lines, Rows kind) {
  std::optional<TableStart> best;
  for (const char delimiter : {'\t', ';', ','}) {
    const auto row = first_row_with(lines, delimiter, kind);
    if (!row) continue;
    const Fields fields = fields_in(lines[*row], delimiter);
    const std::size_t columns = fields.size(), least = columns - (fields.back().empty() ? 1 : 0);
    if (!best || columns > best->columns) best = TableStart{delimiter, *row, {}, {}, columns, least};
  }
  return best;
}

// Moves the start up over rows with an error, so that they are refused later and not skipped.
void take_broken_rows(TableStart& start, std::span<const TableLine> lines) {
  while (start.first_row > 0 && is_half_numbers(fields_in(lines[start.first_row - 1], start.delimiter)))
    --start.first_row;
}

// Whether there are rows before the start. They would be lost, because of a row that is text by mistake.
bool is_after_rows(const TableStart& start, std::span<const TableLine> lines, const Fields& like) {
  return std::ranges::any_of(lines.first(start.first_row), [&](const TableLine& line) {
    const Fields fields = fields_in(line, start.delimiter);
    return is_row(fields, Rows::with_text) && has_text_where(fields, like);
  });
}

bool names_columns(const TableStart& start, const TableLine& line) {
  const Fields fields = fields_in(line, start.delimiter);
  return is_names_alone(fields) && names_for(fields, start).has_value();
}

// A line of units without names before it is an ordinary header.
bool units_under_names(const TableStart& start, std::span<const TableLine> lines) {
  if (start.first_row < 2) return false;
  const Fields units = fields_in(lines[start.first_row - 1], start.delimiter);
  return is_units_row(units) && names_for(units, start) && names_columns(start, lines[start.first_row - 2]);
}

}  // namespace

bool has_text_where(const Fields& a, const Fields& b) {
  return std::ranges::equal(
      a, b, [](const auto& one, const auto& other) { return is_name(one) == is_name(other); });
}

Fields fields_in(const TableLine& line, char delimiter) {
  return fields_of(to_utf8(line.text), delimiter);
}

std::optional<Fields> names_for(Fields fields, const TableStart& start) {
  while (fields.size() > start.columns && (fields.back().empty() || fields.back() == "Comment"))
    fields.pop_back();
  if (fields.size() > start.columns || fields.size() < start.least_names) return std::nullopt;
  fields.resize(start.columns);
  return fields;
}

std::optional<TableStart> find_table_start(std::span<const TableLine> lines) {
  auto start = widest_rows(lines, Rows::numbers_alone);
  if (!start) start = widest_rows(lines, Rows::with_text);
  if (!start) return std::nullopt;
  const Fields sound_row = fields_in(lines[start->first_row], start->delimiter);
  if (!units_under_names(*start, lines)) take_broken_rows(*start, lines);
  if (is_after_rows(*start, lines, sound_row)) return std::nullopt;
  const std::size_t row = start->first_row;
  if (row == 0) return start;
  if (units_under_names(*start, lines)) {
    start->units = row - 1;
    start->names = row - 2;
  } else if (names_columns(*start, lines[row - 1])) {
    start->names = row - 1;
  } else if (field_count(lines[row - 1].text, start->delimiter) > 1) {
    return std::nullopt;
  }
  return start;
}

}  // namespace tacto::capture

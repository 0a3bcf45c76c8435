// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/csv_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>

#include "capture/table/csv_fields.hpp"
#include "capture/table/csv_number.hpp"
#include "capture/table/text_encoding.hpp"
#include "data-schema/base/column_unit.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kSampledLines = 20;

// The offset and the number of the first line.
struct Beginning {
  std::size_t offset = 0, line = 1;
};

// A line that is neither blank nor a comment.
struct TableLine {
  std::string_view text;
  std::size_t number = 0;  // 1-based, of the file
  std::size_t begin = 0;   // its offset
  std::size_t next = 0;    // offset of the line after it
};

struct TableStart {
  char delimiter = ',';
  std::size_t first_row = 0;  // index among the lines, as in the next members
  std::optional<std::size_t> names, units;
  std::size_t columns = 0;
  std::size_t least_names = 0;  // one less if the rows end with a delimiter
};

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

Fields fields_in(const TableLine& line, char delimiter) {
  return fields_of(to_utf8(line.text), delimiter);
}

// Whether two lines have the same number of fields, and text in the same fields.
bool has_text_where(const Fields& a, const Fields& b) {
  return std::ranges::equal(
      a, b, [](const auto& one, const auto& other) { return is_name(one) == is_name(other); });
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

// The fields as column names: a surplus field is dropped if it is empty or "Comment", as LabVIEW writes it.
// nullopt if there are too many or too few.
std::optional<Fields> names_for(Fields fields, const TableStart& start) {
  while (fields.size() > start.columns && (fields.back().empty() || fields.back() == "Comment"))
    fields.pop_back();
  if (fields.size() > start.columns || fields.size() < start.least_names) return std::nullopt;
  fields.resize(start.columns);
  return fields;
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

// Finds the first five consecutive rows of numbers with the same number of fields (fewer if the lines end
// before), and the lines of names and of units directly before them. If no rows consist of numbers alone,
// some columns may be text. A row with an error directly before them belongs to the table: it is refused
// later and not skipped. nullopt if there are no such rows, if lines before them are such rows too, or if
// the line before them has several fields that are neither names nor units.
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

// The first lines that have fields. A line that is cut off at the end of `head` is not used.
std::vector<TableLine> sample_lines(std::string_view head, bool whole, Beginning at, char line_end,
                                    std::size_t most) {
  std::vector<TableLine> lines;
  for (std::size_t begin = at.offset, number = at.line; begin < head.size() && lines.size() < most;
       ++number) {
    const std::size_t end = head.find(line_end, begin);
    if (end == std::string_view::npos && !whole) break;
    const std::size_t next = end == std::string_view::npos ? head.size() : end + 1;
    const auto text = without_returns(head.substr(begin, std::min(end, head.size()) - begin));
    if (!is_blank_line(text) && !is_comment_line(text)) lines.push_back({text, number, begin, next});
    begin = next;
  }
  return lines;
}

// The largest number of lines that this delimiter splits into the same number of fields; 0 if it splits none.
std::size_t agreeing_lines(std::span<const TableLine> lines, char delimiter) {
  std::map<std::size_t, std::size_t> lines_by_fields;
  for (const TableLine& line : lines) ++lines_by_fields[field_count(line.text, delimiter)];
  std::size_t most = 0;
  for (const auto& [fields, count] : lines_by_fields)
    if (fields > 1) most = std::max(most, count);
  return most;
}

// If two delimiters agree equally well, the rarer sign is used: in "0,5;1,5" the comma is decimal.
char find_delimiter(std::span<const TableLine> lines) {
  char best = ',';
  std::size_t most = 0;
  for (const char delimiter : {'\t', ';', ','}) {
    const std::size_t agreeing = agreeing_lines(lines, delimiter);
    if (agreeing > most) best = delimiter;
    most = std::max(most, agreeing);
  }
  return best;
}

enum class FirstLine { header, data, mixed };

// A mixed line is data if the next line has text in the same columns (for example a column of dates).
FirstLine kind_of(const std::vector<std::string>& first, const std::vector<std::string>& next) {
  const auto names = std::ranges::count_if(first, is_name);
  const auto numbers = std::ranges::count_if(first, is_numeric);
  if (names == 0) return FirstLine::data;
  if (numbers == 0) return FirstLine::header;
  for (std::size_t i = 0; i < std::min(first.size(), next.size()); ++i)
    if (is_name(first[i]) && !is_name(next[i])) return names > numbers ? FirstLine::header : FirstLine::mixed;
  return FirstLine::data;
}

Result<void> check_text(std::string_view head, const std::string& file) {
  const bool utf16 = head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF");
  if (utf16) return fail(ErrorKind::malformed, "is UTF-16 text", file, "save it as UTF-8");
  if (const auto zero = head.find('\0'); zero != std::string_view::npos)
    return fail(ErrorKind::malformed, fmt::format("has a zero byte at {}: it is not a text file", zero),
                file);
  return {};
}

tl::unexpected<schema::Error> no_lines(std::string_view head, bool whole, const std::string& file) {
  if (head.empty()) return fail(ErrorKind::malformed, "is empty", file);
  if (!whole)
    return fail(ErrorKind::malformed, fmt::format("has no data in its first {} bytes", head.size()), file);
  return fail(ErrorKind::malformed, "contains no data, only blank lines and comments", file);
}

tl::unexpected<schema::Error> mixed_first_line(const TableLine& line, const std::vector<std::string>& fields,
                                               const std::string& file) {
  const auto at = std::ranges::find_if(fields, is_name) - fields.begin();
  return fail(ErrorKind::malformed,
              fmt::format("'{}' is a name among numbers", fields[static_cast<std::size_t>(at)]),
              fmt::format("{}: line {}, column {}", file, line.number, at + 1),
              "give a name to every column in the first line, or to none");
}

void take_header(CsvLayout& layout, const TableLine& line, std::vector<std::string> fields) {
  layout.header = true;
  layout.columns = std::move(fields);
  layout.header_line = line.number;
  layout.data_offset = line.next;
  layout.data_line = line.number + 1;
}

// A separate row of units follows the header and has priority over the units in the names.
void take_units(CsvLayout& layout, const std::vector<std::string>& row) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i)
    layout.units.push_back(i < row.size() && !row[i].empty() ? row[i]
                                                             : schema::split_unit(layout.columns[i]).unit);
}

// Whether the lines after the first are rows of the same width, with text in the same columns; a row without
// any text is sufficient. If not, the table may begin later.
bool begins_at_once(std::span<const TableLine> lines, char delimiter) {
  if (lines.size() < 2) return true;
  const auto next = fields_in(lines[1], delimiter);
  if (fields_in(lines[0], delimiter).size() != next.size() || std::ranges::none_of(next, is_numeric))
    return false;
  if (std::ranges::none_of(next, is_name)) return true;
  return std::ranges::all_of(lines.subspan(2), [&](const TableLine& line) {
    return has_text_where(fields_in(line, delimiter), next);
  });
}

// With --skip the table begins at the line that the user gives.
std::optional<TableStart> later_start(std::span<const TableLine> lines, bool begin_is_given) {
  auto start = find_table_start(lines);
  if (!start || start->first_row == 0) return std::nullopt;
  const bool at_once = start->names == std::size_t{0};
  return begin_is_given && !at_once ? std::nullopt : start;
}

CsvLayout layout_from(CsvLayout layout, std::span<const TableLine> lines, const TableStart& start) {
  layout.delimiter = start.delimiter;
  layout.columns.assign(start.columns, "");
  layout.lines_before = start.names.value_or(start.first_row);
  if (start.names)
    take_header(layout, lines[*start.names],
                *names_for(fields_in(lines[*start.names], start.delimiter), start));
  if (start.units) layout.units_line = lines[*start.units].number;
  take_units(layout,
             start.units ? fields_in(lines[*start.units], start.delimiter) : std::vector<std::string>{});
  layout.data_offset = lines[start.first_row].begin;
  layout.data_line = lines[start.first_row].number;
  return layout;
}

bool are_numbers_between_blanks(const TableLine& line) {
  std::string fields(line.text);
  std::ranges::replace(fields, '\t', ' ');
  const auto words = fields_of(fields, ' ');
  return std::ranges::none_of(words, is_name) && std::ranges::count_if(words, is_numeric) > 1;
}

bool has_no_number(const TableLine& line, char delimiter) {
  return std::ranges::none_of(fields_in(line, delimiter), is_numeric);
}

// Refuses a text, or columns of a kind that import cannot read.
Result<void> check_rows_follow(std::span<const TableLine> lines, char delimiter, const std::string& file) {
  const auto none = [&](const TableLine& line) { return has_no_number(line, delimiter); };
  if (lines.size() < 2 || !std::ranges::all_of(lines, none)) return {};
  const std::string where =
      fmt::format("{}: lines {} to {}", file, lines.front().number, lines.back().number);
  if (are_numbers_between_blanks(lines.back()))
    return fail(ErrorKind::malformed, "has spaces between its columns", where,
                "save it with commas, semicolons or tabs between them");
  return fail(ErrorKind::malformed, "contains no numbers there", where,
              "a table needs rows of numbers; --skip N ignores N lines before it");
}

Result<CsvLayout> layout_at_once(CsvLayout layout, std::span<const TableLine> lines, bool whole,
                                 const std::string& file) {
  const auto first = fields_in(lines[0], layout.delimiter);
  const auto next = lines.size() > 1 ? fields_in(lines[1], layout.delimiter) : std::vector<std::string>{};
  layout.columns.resize(first.size());
  const FirstLine kind = kind_of(first, next);
  if (kind == FirstLine::mixed) return mixed_first_line(lines[0], first, file);
  TACTO_TRY(check_rows_follow(lines, layout.delimiter, file));
  if (kind == FirstLine::header) take_header(layout, lines[0], first);
  take_units(layout, {});
  if (layout.header && lines.size() == 1 && whole)
    return fail(ErrorKind::malformed, "has a header but no data",
                fmt::format("{}: line {}", file, lines[0].number));
  return layout;
}

Result<Beginning> after_lines(std::string_view head, Beginning at, std::size_t skip, char line_end,
                              const std::string& file) {
  for (std::size_t skipped = 0; skipped < skip; ++skipped, ++at.line) {
    const auto end = head.find(line_end, at.offset);
    if (end == std::string_view::npos)
      return fail(ErrorKind::usage,
                  fmt::format("no table can follow {} lines: the file has {}", skip, skipped),
                  fmt::format("--skip, {}", file), "give the number of lines before the table");
    at.offset = end + 1;
  }
  return at;
}

}  // namespace

Result<CsvLayout> find_csv_layout(std::string_view head, bool whole, const std::string& file,
                                  std::size_t skip) {
  TACTO_TRY(check_text(head, file));
  CsvLayout layout;
  const bool old_mac = head.find('\n') == std::string_view::npos && head.find('\r') != std::string_view::npos;
  layout.line_end = old_mac ? '\r' : '\n';
  const std::size_t mark = head.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  const auto begin = after_lines(head, {mark, 1}, skip, layout.line_end, file);
  TACTO_TRY(begin);
  layout.data_offset = begin->offset;
  layout.data_line = begin->line;
  const auto lines = sample_lines(head, whole, *begin, layout.line_end, kSampledLines);
  if (lines.empty()) return no_lines(head.substr(layout.data_offset), whole, file);
  layout.delimiter = find_delimiter(lines);
  if (!begins_at_once(lines, layout.delimiter)) {
    const auto more = sample_lines(head, whole, *begin, layout.line_end, head.size());
    if (const auto start = later_start(more, skip > 0)) return layout_from(layout, more, *start);
  }
  return layout_at_once(layout, lines, whole, file);
}

}  // namespace tacto::capture

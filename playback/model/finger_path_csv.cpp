// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "data-schema/base/column_unit.hpp"
#include "data-schema/files/files.hpp"
#include "playback/model/finger_path.hpp"

namespace tacto::playback {

using schema::Dimension;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

struct Column {
  std::string quantity;
  Dimension dimension;
};

// The first one is the time.
struct Columns {
  std::vector<Column> all;
  std::size_t needed;  // of them; the others may be absent

  std::string remedy() const {
    std::string header;
    for (std::size_t i = 0; i < needed; ++i)
      header += (i == 0 ? "" : ",") + all[i].quantity + (i == 0 ? "_s" : "_mm");
    return "write a header line with units, such as '" + header + "', then one row per knot";
  }
};

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  auto end = text.find(separator);
  for (; end != std::string_view::npos; end = text.find(separator)) {
    parts.push_back(schema::without_blanks(text.substr(0, end)));
    text.remove_prefix(end + 1);
  }
  parts.push_back(schema::without_blanks(text));
  return parts;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  auto lines = split(text, '\n');
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

// If commas do not separate columns, both comma and point are decimal marks.
char separator_of(std::string_view header) {
  if (header.find('\t') != std::string_view::npos) return '\t';
  return header.find(';') != std::string_view::npos ? ';' : ',';
}

std::optional<double> number_in(std::string_view field, char separator) {
  double value = 0;
  if (field.starts_with('+')) field.remove_prefix(1);
  std::string text(field);
  if (separator != ',' && std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos)
    std::ranges::replace(text, ',', '.');
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

struct Table {
  const std::string& name;
  const Columns& columns;
  char separator;
  std::vector<std::string_view> header;
  std::vector<std::optional<std::size_t>> column = {};  // their indices in the header
  std::vector<double> si = {};                          // values of their units

  std::string place(std::size_t line, std::size_t which) const {
    return fmt::format("{}, line {}, column {} ({})", name, line, *column[which] + 1, header[*column[which]]);
  }
};

// "Normal force" as "normal_force".
std::string plain_name(std::string name) {
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return c == ' ' ? '_' : static_cast<char>(std::tolower(c)); });
  return name;
}

bool is_of(std::string_view column, const std::string& quantity) {
  return plain_name(schema::split_unit(column).name) == quantity;
}

// The column of a quantity and its unit: "position_mm", "Position (mm)" or "position / mm".
Result<void> find_column(Table& table, std::size_t which) {
  const auto& [quantity, dimension] = table.columns.all[which];
  const auto is_it = [&quantity = quantity](std::string_view name) { return is_of(name, quantity); };
  const auto found = std::ranges::find_if(table.header, is_it);
  const std::string line = table.name + ", line 1";
  table.column.emplace_back();
  table.si.push_back(1);
  if (found == table.header.end() && which >= table.columns.needed) return {};
  if (found == table.header.end())
    return fail(ErrorKind::malformed,
                fmt::format("there is no column '{}', only {}", quantity, fmt::join(table.header, ", ")),
                line, table.columns.remedy());
  if (std::ranges::count_if(table.header, is_it) > 1)
    return fail(ErrorKind::malformed, fmt::format("there are several columns '{}'", quantity), line,
                "remove all but one");
  const auto unit = schema::known_unit(schema::split_unit(*found).unit, dimension);
  if (!unit || unit->dimension != dimension)
    return fail(ErrorKind::malformed, fmt::format("the column '{}' has no unit of {}", *found, quantity),
                line,
                fmt::format("write {}_{}; the units are {}", quantity, schema::si_symbol(dimension),
                            schema::units_of(dimension)));
  table.column.back() = found - table.header.begin();
  table.si.back() = unit->si;
  return {};
}

Result<Table> read_header(std::string_view line, const std::string& name, const Columns& columns) {
  if (std::ranges::any_of(line, [](char c) { return c >= 0 && c < ' ' && c != '\t'; }))
    return fail(ErrorKind::malformed, "this is not a table: its first line contains binary data", name,
                columns.remedy());
  const char separator = separator_of(line);
  Table table{name, columns, separator, split(line, separator)};
  for (std::size_t which = 0; which < columns.all.size(); ++which) TACTO_TRY(find_column(table, which));
  return table;
}

Result<double> cell(const Table& table, const std::vector<std::string_view>& fields, std::size_t line,
                    std::size_t which) {
  const std::string_view text = fields[*table.column[which]];
  const auto value = number_in(text, table.separator);
  if (!value)
    return fail(ErrorKind::malformed, fmt::format("'{}' is not a number", text), table.place(line, which));
  if (!std::isfinite(*value))
    return fail(ErrorKind::malformed, fmt::format("'{}' is not finite", text), table.place(line, which));
  return *value * table.si[which];
}

// The numbers of each column; without one that is absent.
using Numbers = std::vector<std::vector<double>>;

Result<void> add_row(Numbers& numbers, const Table& table, std::string_view text, std::size_t line) {
  const auto fields = split(text, table.separator);
  if (fields.size() != table.header.size())
    return fail(ErrorKind::malformed,
                fmt::format("the row has {} fields, the header {}", fields.size(), table.header.size()),
                fmt::format("{}, line {}", table.name, line));
  for (std::size_t which = 0; which < numbers.size(); ++which) {
    if (!table.column[which]) continue;
    const auto value = cell(table, fields, line, which);
    TACTO_TRY(value);
    auto& column = numbers[which];
    if (which == 0 && !column.empty() && *value <= column.back())
      return fail(ErrorKind::malformed,
                  fmt::format("the time does not increase: {} s after {} s", *value, column.back()),
                  table.place(line, 0), "each row must be later than the one before");
    column.push_back(*value);
  }
  return {};
}

Result<Numbers> parse_columns(std::string_view text, const std::string& name, const Columns& columns) {
  const auto lines = lines_of(text);
  if (lines.empty()) return fail(ErrorKind::malformed, "the file is empty", name, columns.remedy());
  const auto table = read_header(lines.front(), name, columns);
  TACTO_TRY(table);
  Numbers numbers(columns.all.size());
  for (std::size_t i = 1; i < lines.size(); ++i) TACTO_TRY(add_row(numbers, *table, lines[i], i + 1));
  if (numbers.front().size() < 2)
    return fail(ErrorKind::malformed,
                fmt::format("a path needs at least 2 rows, this one has {}", numbers.front().size()), name,
                columns.remedy());
  return numbers;
}

}  // namespace

Result<FingerPath> parse_finger_path(std::string_view text, const std::string& name) {
  auto numbers = parse_columns(
      text, name,
      {{{"time", Dimension::time}, {"position", Dimension::length}, {"normal_force", Dimension::force}}, 2});
  TACTO_TRY(numbers);
  return FingerPath{std::move((*numbers)[0]), std::move((*numbers)[1]), std::move((*numbers)[2])};
}

Result<FingerPath> read_finger_path(const std::string& file) {
  const auto text = schema::read_file(file);
  TACTO_TRY(text);
  return parse_finger_path(*text, file);
}

bool has_column(std::string_view text, const std::string& quantity) {
  const auto lines = lines_of(text);
  if (lines.empty()) return false;
  const auto header = split(lines.front(), separator_of(lines.front()));
  return std::ranges::any_of(header, [&](std::string_view column) { return is_of(column, quantity); });
}

Result<std::vector<FingerPath>> read_axis_paths(const std::string& file,
                                                const std::vector<std::string>& axes) {
  Columns columns{{{"time", Dimension::time}}, axes.size() + 1};
  for (const std::string& axis : axes) columns.all.push_back({axis, Dimension::length});
  const auto text = schema::read_file(file);
  TACTO_TRY(text);
  const auto numbers = parse_columns(*text, file, columns);
  TACTO_TRY(numbers);
  std::vector<FingerPath> paths;
  for (std::size_t i = 1; i < numbers->size(); ++i) paths.push_back({numbers->front(), (*numbers)[i]});
  return paths;
}

}  // namespace tacto::playback

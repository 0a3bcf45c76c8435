// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
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

struct Quantity {
  std::string_view name;
  Dimension dimension;
};
constexpr std::array<Quantity, 3> kColumns = {
    {{"time", Dimension::time}, {"position", Dimension::length}, {"normal_force", Dimension::force}}};
constexpr std::size_t kNeeded = 2, kForce = 2;
constexpr std::string_view kRemedy =
    "write a header line with units, such as 'time_s,position_mm', then one row per knot";

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
  char separator;
  std::vector<std::string_view> header;
  std::array<std::size_t, kColumns.size()> column{};  // their indices in the header
  std::array<double, kColumns.size()> si{};           // values of their units
  bool has_force = false;

  std::string place(std::size_t line, std::size_t which) const {
    return fmt::format("{}, line {}, column {} ({})", name, line, column[which] + 1, header[column[which]]);
  }
};

// The column of a quantity and its unit: "position_mm", "position (mm)" or "position / mm".
Result<void> find_column(Table& table, std::size_t which) {
  const auto [quantity, dimension] = kColumns[which];
  const auto is_it = [&](std::string_view name) { return schema::split_unit(name).name == quantity; };
  const auto found = std::ranges::find_if(table.header, is_it);
  const std::string line = table.name + ", line 1";
  if (which == kForce) table.has_force = found != table.header.end();
  if (found == table.header.end() && which >= kNeeded) return {};
  if (found == table.header.end())
    return fail(ErrorKind::malformed,
                fmt::format("there is no column '{}', only {}", quantity, fmt::join(table.header, ", ")),
                line, std::string(kRemedy));
  if (std::ranges::count_if(table.header, is_it) > 1)
    return fail(ErrorKind::malformed, fmt::format("there are several columns '{}'", quantity), line,
                "remove all but one");
  const auto unit = schema::known_unit(schema::split_unit(*found).unit, dimension);
  if (!unit || unit->dimension != dimension)
    return fail(ErrorKind::malformed, fmt::format("the column '{}' has no unit of {}", *found, quantity),
                line,
                fmt::format("write {}_{}; the units are {}", quantity, schema::si_symbol(dimension),
                            schema::units_of(dimension)));
  table.column[which] = static_cast<std::size_t>(found - table.header.begin());
  table.si[which] = unit->si;
  return {};
}

Result<Table> read_header(std::string_view line, const std::string& name) {
  if (std::ranges::any_of(line, [](char c) { return c >= 0 && c < ' ' && c != '\t'; }))
    return fail(ErrorKind::malformed, "this is not a table: its first line contains binary data", name,
                std::string(kRemedy));
  const char separator = separator_of(line);
  Table table{name, separator, split(line, separator), {}, {}, false};
  for (std::size_t which = 0; which < kColumns.size(); ++which) TACTO_TRY(find_column(table, which));
  return table;
}

Result<double> cell(const Table& table, const std::vector<std::string_view>& fields, std::size_t line,
                    std::size_t which) {
  const std::string_view text = fields[table.column[which]];
  const auto value = number_in(text, table.separator);
  if (!value)
    return fail(ErrorKind::malformed, fmt::format("'{}' is not a number", text), table.place(line, which));
  if (!std::isfinite(*value))
    return fail(ErrorKind::malformed, fmt::format("'{}' is not finite", text), table.place(line, which));
  return *value * table.si[which];
}

Result<void> add_row(FingerPath& path, const Table& table, std::string_view text, std::size_t line) {
  const auto fields = split(text, table.separator);
  if (fields.size() != table.header.size())
    return fail(ErrorKind::malformed,
                fmt::format("the row has {} fields, the header {}", fields.size(), table.header.size()),
                fmt::format("{}, line {}", table.name, line));
  const auto time_s = cell(table, fields, line, 0);
  TACTO_TRY(time_s);
  const auto position_m = cell(table, fields, line, 1);
  TACTO_TRY(position_m);
  if (!path.time_s.empty() && *time_s <= path.time_s.back())
    return fail(ErrorKind::malformed,
                fmt::format("the time does not increase: {} s after {} s", *time_s, path.time_s.back()),
                table.place(line, 0), "each row must be later than the one before");
  path.time_s.push_back(*time_s);
  path.position_m.push_back(*position_m);
  if (!table.has_force) return {};
  const auto force_n = cell(table, fields, line, kForce);
  TACTO_TRY(force_n);
  path.normal_force_n.push_back(*force_n);
  return {};
}

}  // namespace

Result<FingerPath> parse_finger_path(std::string_view text, const std::string& name) {
  const auto lines = lines_of(text);
  if (lines.empty()) return fail(ErrorKind::malformed, "the file is empty", name, std::string(kRemedy));
  const auto table = read_header(lines.front(), name);
  TACTO_TRY(table);
  FingerPath path;
  for (std::size_t i = 1; i < lines.size(); ++i) TACTO_TRY(add_row(path, *table, lines[i], i + 1));
  if (path.time_s.size() < 2)
    return fail(ErrorKind::malformed,
                fmt::format("a path needs at least 2 rows, this one has {}", path.time_s.size()), name,
                std::string(kRemedy));
  return path;
}

Result<FingerPath> read_finger_path(const std::string& file) {
  const auto text = schema::read_file(file);
  TACTO_TRY(text);
  return parse_finger_path(*text, file);
}

}  // namespace tacto::playback

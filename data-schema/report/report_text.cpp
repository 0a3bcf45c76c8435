// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/report_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "data-schema/report/report_entries.hpp"
#include "data-schema/report/text_table.hpp"
#include "data-schema/report/value_text.hpp"

namespace tacto::cli {
namespace {

using Lines = std::vector<std::string>;

void append(Lines& lines, const Lines& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

std::vector<std::string> keys_of(const std::vector<Report>& rows) {
  std::vector<std::string> keys;
  for (const Report& row : rows)
    for (const auto& [key, value] : ReportPrinter::entries(row))
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  return keys;
}

std::string find_cell(const Report& row, const std::string& key) {
  for (const auto& [name, value] : ReportPrinter::entries(row))
    if (name == key) return cell_text(key, value);
  return "";
}

bool is_nested(const Report& row) {
  return std::ranges::any_of(ReportPrinter::entries(row), [](const auto& entry) {
    return std::holds_alternative<std::vector<Report>>(entry.second);
  });
}

// nullopt for rows with tables of their own or with many columns, and for a table that is too wide.
std::optional<Lines> table_of(const std::vector<Report>& rows, std::size_t columns) {
  constexpr std::size_t kMostColumns = 20;
  const auto keys = keys_of(rows);
  if (keys.size() > kMostColumns || std::ranges::any_of(rows, is_nested)) return std::nullopt;
  TextRow header = labels_of(keys);
  std::vector<TextRow> cells;
  for (const Report& row : rows) {
    cells.emplace_back();
    for (const auto& key : keys) cells.back().push_back(find_cell(row, key));
  }
  return table_lines(std::move(header), std::move(cells), columns);
}

Lines split(const std::string& text) {
  Lines lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

// "label   text"; where the text wraps, its further lines begin below its first. Lines of the text itself
// stay lines.
Lines figure_lines(const std::string& label, const std::string& text, std::size_t label_width,
                   std::size_t columns) {
  const std::size_t room = columns > label_width + 20 ? columns - label_width : 0;
  Lines lines = split(text);
  const Lines first = room == 0 ? Lines{lines.front()} : wrapped_text(lines.front(), room);
  lines.erase(lines.begin());
  Lines all;
  for (std::size_t i = 0; i < first.size(); ++i)
    all.push_back(padded(i == 0 ? label : "", label_width) + first[i]);
  for (const std::string& line : lines) append(all, columns == 0 ? Lines{line} : wrapped_text(line, columns));
  return all;
}

Lines all_lines(const Report& report, std::size_t columns, std::size_t most_rows);

Lines list_lines(const std::vector<Report>& rows, std::size_t columns, std::size_t most_rows) {
  if (rows.empty()) return {"  none"};
  const std::vector<Report> shown(
      rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(std::min(rows.size(), most_rows)));
  Lines lines;
  if (auto table = table_of(shown, columns)) {
    lines = std::move(*table);
  } else {
    for (const Report& row : shown) {
      lines.emplace_back();
      append(lines, all_lines(row, columns, most_rows));
    }
  }
  if (const std::size_t more = rows.size() - shown.size(); more > 0)
    lines.push_back(fmt::format("  and {} more row{} (--rows all)", more, more == 1 ? "" : "s"));
  return lines;
}

std::size_t label_width_of(const std::vector<std::string>& labels) {
  std::size_t width = 0;
  for (const std::string& label : labels) width = std::max(width, width_of(label));
  return width + 2;
}

Lines all_lines(const Report& report, std::size_t columns, std::size_t most_rows) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : ReportPrinter::entries(report)) keys.push_back(key);
  const auto labels = labels_of(keys);
  const std::size_t width = label_width_of(labels);
  Lines lines;
  std::size_t i = 0;
  for (const auto& [key, value] : ReportPrinter::entries(report)) {
    const std::string& label = labels[i++];
    if (const auto* rows = std::get_if<std::vector<Report>>(&value)) {
      lines.push_back(label);
      append(lines, list_lines(*rows, columns, most_rows));
    } else {
      append(lines, figure_lines(label, cell_text(key, value), width, columns));
    }
  }
  return lines;
}

}  // namespace

std::string text_of(const Report& report, const TextLimits& limits) {
  constexpr std::size_t kFewestRows = 5;
  Lines lines = all_lines(report, limits.columns, limits.rows);
  for (std::size_t rows = limits.lines; rows >= kFewestRows && lines.size() > limits.lines; --rows)
    lines = all_lines(report, limits.columns, rows);
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace tacto::cli

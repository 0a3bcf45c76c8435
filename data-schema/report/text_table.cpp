// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/text_table.hpp"

#include <algorithm>

#include "data-schema/report/value_text.hpp"

namespace tacto::cli {

std::vector<std::string> wrapped_text(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && width_of(line) + 1 + width_of(word) > width)
      lines.push_back(std::move(line)), line.clear();
    line += line.empty() ? word : " " + word;
    at = end + 1;
  }
  lines.push_back(std::move(line));
  return lines;
}

namespace {

using Lines = std::vector<std::string>;

void drop_empty_columns(TextRow& header, std::vector<TextRow>& rows) {
  for (std::size_t c = header.size(); c-- > 0;) {
    if (std::ranges::any_of(rows, [&](const TextRow& row) { return !row[c].empty(); })) continue;
    const auto at = static_cast<std::ptrdiff_t>(c);
    header.erase(header.begin() + at);
    for (TextRow& row : rows) row.erase(row.begin() + at);
  }
}

std::size_t width_of_values(const std::vector<TextRow>& rows, std::size_t column) {
  std::size_t width = 0;
  for (const TextRow& row : rows) width = std::max(width, width_of(row[column]));
  return width;
}

std::string line_of(const TextRow& cells, const std::vector<std::size_t>& widths) {
  std::string line = " ";
  for (std::size_t c = 0; c < cells.size(); ++c) line += " " + padded(cells[c], widths[c]) + " ";
  const std::size_t last = line.find_last_not_of(' ');
  return last == line.npos ? "" : line.substr(0, last + 1);
}

// The header of each column in lines; the last ones are directly above the values.
std::optional<Lines> lines_of(const std::vector<Lines>& headers, const std::vector<TextRow>& rows,
                              std::size_t most) {
  std::vector<std::size_t> widths;
  std::size_t height = 0, total = 0;
  for (std::size_t c = 0; c < headers.size(); ++c) {
    widths.push_back(width_of_values(rows, c));
    for (const std::string& line : headers[c]) widths.back() = std::max(widths.back(), width_of(line));
    height = std::max(height, headers[c].size());
    total += 2 + widths.back();
  }
  if (most > 0 && total > most) return std::nullopt;
  Lines lines;
  for (std::size_t i = 0; i < height; ++i) {
    TextRow cells;
    for (const Lines& header : headers) {
      const std::size_t missing = height - header.size();
      cells.push_back(i < missing ? "" : header[i - missing]);
    }
    lines.push_back(line_of(cells, widths));
  }
  for (const TextRow& row : rows) lines.push_back(line_of(row, widths));
  return lines;
}

}  // namespace

std::optional<Lines> table_lines(TextRow header, std::vector<TextRow> rows, std::size_t width) {
  std::vector<Lines> headers;
  for (const std::string& each : header) headers.push_back({each});
  if (auto lines = lines_of(headers, rows, width)) return lines;
  drop_empty_columns(header, rows);
  headers.clear();
  for (std::size_t c = 0; c < header.size(); ++c)
    headers.push_back(wrapped_text(header[c], std::max<std::size_t>(1, width_of_values(rows, c))));
  return lines_of(headers, rows, width);
}

}  // namespace tacto::cli

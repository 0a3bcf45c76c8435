// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/text_table.hpp"

#include <algorithm>

#include "data-schema/report/value_text.hpp"

namespace tacto::cli {
namespace {

constexpr std::size_t kIndent = 4;  // of a row's further lines

std::size_t widest_of(const std::vector<std::string>& lines) {
  std::size_t widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, width_of(line));
  return widest;
}

}  // namespace

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

TextTable::TextTable(TextRow header, std::vector<TextRow> rows, std::size_t width)
    : header_(std::move(header)), rows_(std::move(rows)), width_(width) {
  for (const std::string& each : header_) header_words_.push_back({each});
  measure();
  if (width_ == 0 || run_width({0, columns()}) <= width_) return;
  drop_empty_columns();
  // A header narrower than its values costs no width; a wider one breaks at its spaces.
  header_words_.clear();
  for (std::size_t c = 0; c < columns(); ++c) {
    std::size_t values = 1;
    for (const TextRow& row : rows_) values = std::max(values, width_of(row[c]));
    header_words_.push_back(wrapped_text(header_[c], values));
  }
  measure();
}

void TextTable::drop_empty_columns() {
  for (std::size_t c = columns(); c-- > 0;) {
    if (std::ranges::any_of(rows_, [&](const TextRow& row) { return !row[c].empty(); })) continue;
    const auto at = static_cast<std::ptrdiff_t>(c);
    header_.erase(header_.begin() + at);
    for (TextRow& row : rows_) row.erase(row.begin() + at);
  }
}

void TextTable::measure() {
  widths_.assign(columns(), 0);
  for (std::size_t c = 0; c < columns(); ++c) {
    widths_[c] = widest_of(header_words_[c]);
    for (const TextRow& row : rows_) widths_[c] = std::max(widths_[c], width_of(row[c]));
  }
}

// A space before each cell, and one after it if another follows.
std::size_t TextTable::run_width(const Run& run) const {
  std::size_t width = 0;
  for (std::size_t c = run.from; c < run.to; ++c) width += 2 + widths_[c];
  return width;
}

std::vector<TextTable::Run> TextTable::runs() const {
  std::vector<Run> runs = {{0, 0}};
  for (std::size_t c = 0; c < columns(); ++c) {
    const std::size_t indent = runs.size() > 1 ? kIndent : 0;
    const bool fits = width_ == 0 || indent + run_width({runs.back().from, c + 1}) <= width_;
    if (!fits && runs.back().to > runs.back().from) runs.push_back({c, c});
    runs.back().to = c + 1;
  }
  return runs;
}

std::string TextTable::line_of(const TextRow& cells, const Run& run, std::size_t indent) const {
  std::string line(indent + 1, ' ');
  for (std::size_t c = run.from; c < run.to; ++c) line += " " + padded(cells[c - run.from], widths_[c]) + " ";
  const std::size_t last = line.find_last_not_of(' ');
  return last == line.npos ? "" : line.substr(0, last + 1);
}

// The headers' last lines are directly above the values.
std::vector<std::string> TextTable::header_lines(const Run& run, std::size_t indent) const {
  std::size_t most = 0;
  for (std::size_t c = run.from; c < run.to; ++c) most = std::max(most, header_words_[c].size());
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < most; ++i) {
    TextRow cells;
    for (std::size_t c = run.from; c < run.to; ++c) {
      const std::size_t missing = most - header_words_[c].size();
      cells.push_back(i < missing ? "" : header_words_[c][i - missing]);
    }
    lines.push_back(line_of(cells, run, indent));
  }
  return lines;
}

std::vector<std::string> TextTable::row_lines(const TextRow& row, const Run& run, std::size_t indent) const {
  const TextRow cells(row.begin() + static_cast<std::ptrdiff_t>(run.from),
                      row.begin() + static_cast<std::ptrdiff_t>(run.to));
  if (width_ == 0 || cells.size() > 1 || indent + run_width(run) <= width_)
    return {line_of(cells, run, indent)};
  std::vector<std::string> lines;
  for (const std::string& piece : wrapped_text(cells.front(), width_ - indent - 2))
    lines.push_back(std::string(indent + 2, ' ') + piece);
  return lines;
}

std::vector<std::string> TextTable::lines() const {
  std::vector<std::string> all;
  const auto add = [&](const std::vector<std::string>& lines) {
    all.insert(all.end(), lines.begin(), lines.end());
  };
  const auto each_run = runs();
  for (const Run& run : each_run) add(header_lines(run, run.from == 0 ? 0 : kIndent));
  for (const TextRow& row : rows_)
    for (const Run& run : each_run) add(row_lines(row, run, run.from == 0 ? 0 : kIndent));
  return all;
}

TextTable::Part TextTable::part(std::size_t most_lines) const {
  const Run run = runs().front();
  Part part{header_lines(run, 0), 0, run.to};
  for (const TextRow& row : rows_) {
    const auto lines = row_lines(row, run, 0);
    if (part.lines.size() + lines.size() > most_lines) break;
    part.lines.insert(part.lines.end(), lines.begin(), lines.end());
    ++part.rows;
  }
  if (part.rows == 0) part.lines.clear();
  return part;
}

}  // namespace tacto::cli

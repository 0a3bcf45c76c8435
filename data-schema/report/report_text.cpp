// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/report_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

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

// Rows with tables of their own, or with more columns than fit on a line, are printed one below the other.
bool is_table(const std::vector<Report>& rows) {
  constexpr std::size_t kMostColumns = 20;
  return keys_of(rows).size() <= kMostColumns && std::ranges::none_of(rows, is_nested);
}

TextTable table_of(const std::vector<Report>& rows, std::size_t columns) {
  const auto keys = keys_of(rows);
  TextRow header;
  for (const auto& key : keys) header.push_back(label_of(key));
  std::vector<TextRow> cells;
  for (const Report& row : rows) {
    cells.emplace_back();
    for (const auto& key : keys) cells.back().push_back(find_cell(row, key));
  }
  return {std::move(header), std::move(cells), columns};
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

Lines all_lines(const Report& report, std::size_t columns);

Lines list_lines(const std::vector<Report>& rows, std::size_t columns) {
  if (rows.empty()) return {"  none"};
  if (is_table(rows)) return table_of(rows, columns).lines();
  Lines lines;
  for (const Report& row : rows) {
    lines.emplace_back();
    append(lines, all_lines(row, columns));
  }
  return lines;
}

std::size_t label_width_of(const Report& report) {
  std::size_t width = 0;
  for (const auto& [key, value] : ReportPrinter::entries(report))
    width = std::max(width, width_of(label_of(key)));
  return width + 2;
}

Lines all_lines(const Report& report, std::size_t columns) {
  const std::size_t width = label_width_of(report);
  Lines lines;
  for (const auto& [key, value] : ReportPrinter::entries(report)) {
    if (const auto* rows = std::get_if<std::vector<Report>>(&value)) {
      lines.push_back(label_of(key));
      append(lines, list_lines(*rows, columns));
    } else {
      append(lines, figure_lines(label_of(key), cell_text(key, value), width, columns));
    }
  }
  return lines;
}

// Entries that a short report keeps before all other figures: where the results are, whether they are valid,
// what to do next.
constexpr std::array<std::string_view, 21> kKept = {
    "file",       "files",    "page",      "written",   "results", "picture",     "session",
    "transducer", "verdict",  "simulated", "fault",     "failed",  "ended",       "next",
    "exit",       "error_db", "texture",   "recording", "pace",    "lost_frames", "beyond_measurement_noise"};

bool is_kept(const std::string& key) {
  return std::ranges::find(kKept, key) != kKept.end();
}

// A report in few lines: at first one line for each entry, then as many more for each as there are.
class ShortText {
 public:
  ShortText(const Report& report, const TextLimits& limits)
      : limits_(limits), width_(label_width_of(report)) {
    for (const auto& [key, value] : ReportPrinter::entries(report)) add(key, value);
  }

  Lines lines() {
    pack_figures();
    drop_figures();
    share_out();
    Lines lines;
    for (const Block& block : blocks_)
      if (block.shown > 0 || !block.table)
        lines.insert(lines.end(), block.lines.begin(),
                     block.lines.begin() + static_cast<std::ptrdiff_t>(block.shown));
    if (const std::string words = missing_words(); !words.empty())
      lines.push_back(fmt::format("not shown: {}; --json prints all", words));
    return lines;
  }

 private:
  struct Block {
    std::string key;
    Lines lines;
    std::size_t shown = 1;
    std::size_t missing_rows = 0, missing_columns = 0;
    bool joinable = false;    // a short figure with room beside it
    std::size_t figures = 1;  // two if another is beside it
    std::optional<TextTable> table;
  };

  void add(const std::string& key, const ReportPrinter::Value& value) {
    Block block;
    block.key = key;
    if (const auto* rows = std::get_if<std::vector<Report>>(&value)) {
      if (!rows->empty() && is_table(*rows)) block.table = table_of(*rows, limits_.columns);
      block.missing_rows = rows->size();
      block.lines = {
          padded(label_of(key), width_) +
          (rows->empty() ? "none" : fmt::format("{} row{}", rows->size(), rows->size() == 1 ? "" : "s"))};
    } else {
      block.lines = figure_lines(label_of(key), cell_text(key, value), width_, limits_.columns);
    }
    blocks_.push_back(std::move(block));
  }

  // The last line states what is missing.
  std::size_t room() const {
    std::size_t used = 1;
    for (const Block& block : blocks_) used += block.shown;
    return used < limits_.lines ? limits_.lines - used : 0;
  }

  // Consecutive short figures are printed two on a line.
  void pack_figures() {
    const std::size_t half = limits_.columns / 2;
    const auto is_short = [&](const Block& block) {
      return !block.table && block.missing_rows == 0 && block.lines.size() == 1 && !is_kept(block.key) &&
             width_of(block.lines.front()) + 2 <= half;
    };
    std::vector<Block> packed;
    for (Block& block : blocks_) {
      const bool joins = !packed.empty() && packed.back().joinable && is_short(block);
      if (joins) {
        packed.back().lines.front() = padded(packed.back().lines.front(), half) + block.lines.front();
        packed.back().joinable = false;
        packed.back().figures = 2;
        continue;
      }
      block.joinable = is_short(block);
      packed.push_back(std::move(block));
    }
    blocks_ = std::move(packed);
  }

  void drop_figures() {
    for (const bool kept : {false, true})
      while (blocks_.size() + 1 > limits_.lines && drop_last(kept)) {
      }
    // The first table is the main result: some of its rows come before less important figures.
    const auto table =
        std::ranges::find_if(blocks_, [](const Block& block) { return block.table.has_value(); });
    if (table == blocks_.end()) return;
    constexpr std::size_t kFewRows = 4, kHeader = 2;
    const std::size_t target = std::min(kFewRows, table->table->rows()) + kHeader;
    while (room() < target && drop_last(false)) {
    }
  }

  // The last figure, kept or not; never a table.
  bool drop_last(bool kept) {
    const auto last = std::ranges::find_if(blocks_.rbegin(), blocks_.rend(), [&](const Block& block) {
      return !block.table && is_kept(block.key) == kept;
    });
    if (last == blocks_.rend()) return false;
    if (last->missing_rows > 0)
      missing_rows_ += last->missing_rows;
    else
      missing_figures_ += last->figures;
    blocks_.erase(std::next(last).base());
    return true;
  }

  void share_out() {
    for (Block& block : blocks_)
      if (block.table) show_rows(block);
    for (Block& block : blocks_)
      if (!block.table) block.shown += std::min(room(), block.lines.size() - block.shown);
  }

  void show_rows(Block& block) {
    const TextTable::Part part = block.table->part(room());
    if (part.rows == 0) return;
    block.missing_rows = block.table->rows() - part.rows;
    block.missing_columns = block.table->columns() - part.columns;
    append(block.lines, part.lines);
    block.shown = block.lines.size();
  }

  std::string missing_words() const {
    std::size_t rows = missing_rows_, columns = 0, lines = 0;
    for (const Block& block : blocks_) {
      rows += block.missing_rows;
      columns += block.missing_columns;
      lines += block.lines.size() - block.shown;
    }
    std::string words;
    for (const auto& [count, what] :
         {std::pair{rows, "row"}, {columns, "column"}, {missing_figures_, "figure"}, {lines, "line"}})
      if (count > 0)
        words += fmt::format("{}{} {}{}", words.empty() ? "" : ", ", count, what, count == 1 ? "" : "s");
    return words;
  }

  TextLimits limits_;
  std::size_t width_, missing_figures_ = 0, missing_rows_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace

std::string text_of(const Report& report, const TextLimits& limits) {
  Lines lines = all_lines(report, limits.columns);
  if (limits.lines > 0 && lines.size() > limits.lines) lines = ShortText(report, limits).lines();
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace tacto::cli

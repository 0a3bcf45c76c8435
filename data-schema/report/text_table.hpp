// SPDX-License-Identifier: GPL-3.0-or-later
// A table on a terminal within a given width. Internal to this folder.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tacto::cli {

using TextRow = std::vector<std::string>;

/// The text in lines no wider than `width`, broken at spaces; a longer word has a line of its own.
std::vector<std::string> wrapped_text(const std::string& text, std::size_t width);

/// Header and rows, all with the same number of cells. If the cells of a row do not fit beside each other,
/// headers break at spaces, columns without values are left out, and the rest of each row continues in
/// indented lines.
class TextTable {
 public:
  TextTable(TextRow header, std::vector<TextRow> rows, std::size_t width);

  /// All of it.
  std::vector<std::string> lines() const;

  /// At most so many lines: the first rows, each on one line, with as many columns as fit.
  struct Part {
    std::vector<std::string> lines;
    std::size_t rows = 0, columns = 0;
  };
  Part part(std::size_t most_lines) const;

  std::size_t rows() const { return rows_.size(); }
  std::size_t columns() const { return header_.size(); }

 private:
  struct Run {
    std::size_t from = 0, to = 0;  // columns on one line
  };
  void drop_empty_columns();
  void measure();
  std::size_t run_width(const Run& run) const;
  std::vector<Run> runs() const;
  std::vector<std::string> header_lines(const Run& run, std::size_t indent) const;
  std::vector<std::string> row_lines(const TextRow& row, const Run& run, std::size_t indent) const;
  std::string line_of(const TextRow& cells, const Run& run, std::size_t indent) const;

  TextRow header_;
  std::vector<TextRow> rows_;
  std::vector<std::vector<std::string>> header_words_;  // each header in its lines
  std::vector<std::size_t> widths_;
  std::size_t width_;
};

}  // namespace tacto::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a self-contained HTML page.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tacto::analysis {

/// Text with <, >, & and quotes written as entities; bytes that are no UTF-8 as U+FFFD.
std::string escaped(std::string_view text);

/// An <img> that holds its SVG as a data: URI; `alternative` is read where pictures can't be seen.
std::string inline_svg(std::string_view svg, std::string_view alternative);

/// A column of a table whose rows are `Row`s: its header and what a row shows below it, together, so that a
/// table has as many headers as cells a row.
template <class Row>
class Column {
 public:
  template <class Cell>
    requires std::is_invocable_r_v<std::string, Cell, const Row&>
  Column(std::string header, Cell of_row) : header_(std::move(header)), cell_(std::move(of_row)) {}

  const std::string& header() const { return header_; }
  std::string cell(const Row& row) const { return cell_(row); }

 private:
  std::string header_;
  std::function<std::string(const Row&)> cell_;
};

/// The cell of a row and a column, by number.
using CellText = std::function<std::string(std::size_t row, std::size_t column)>;

/// A <table> with one row for each of `rows`. Headers and cells are escaped. On a narrow screen each row
/// becomes a list of "header: cell"; no cell is ever cut.
std::string html_table(const std::vector<std::string>& headers, std::size_t rows, const CellText& cell);

template <class Row>
std::string html_table(const std::vector<Row>& rows,
                       const std::type_identity_t<std::vector<Column<Row>>>& columns) {
  std::vector<std::string> headers;
  for (const Column<Row>& column : columns) headers.push_back(column.header());
  return html_table(headers, rows.size(),
                    [&](std::size_t row, std::size_t column) { return columns[column].cell(rows[row]); });
}

/// A <table>; the first row is its head. Cells are escaped. Precondition: all rows of equal size. New tables
/// take columns instead.
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// `html` under a line that opens it: for what stands behind the answer, as long tables. Closed at first.
std::string folded(std::string_view summary, std::string_view html);

/// The sentence that answers the page's question: in large letters, before everything else.
std::string answer(std::string_view sentence);

/// The box that says by what a page's data were simulated; empty where they were not.
std::string simulated_box(std::string_view by_what);

/// A whole document around `body`, with the house's style sheet inside.
std::string html_document(std::string_view title, std::string_view body);

}  // namespace tacto::analysis

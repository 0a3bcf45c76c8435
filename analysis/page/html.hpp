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

/// Writes <, >, & and quotes as entities, bytes that are not UTF-8 as U+FFFD, and between a number and its
/// unit, and between p and its number, a space that does not break; um, us and uV after a number as people
/// print them.
std::string escaped(std::string_view text);
/// "12 um" as "12 µm", for the text of a picture; as escaped(), but plain text.
std::string with_micro_signs(std::string_view text);

/// An <img> with its SVG as a data: URI, in a box that scrolls where the screen is too narrow to read it;
/// `alternative` is the text for readers without pictures.
std::string inline_svg(std::string_view svg, std::string_view alternative);

/// A column of a table whose rows are `Row`s: the header and the text of a cell together, so that their
/// numbers agree.
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

/// The id on the page to which the first cell of a row leads.
using RowTarget = std::function<std::string(std::size_t row)>;

/// A <table> with `rows` rows. Headers and cells are escaped. On a narrow screen each row becomes a list of
/// "header: cell"; cells wrap and are never cut.
std::string html_table(const std::vector<std::string>& headers, std::size_t rows, const CellText& cell,
                       const RowTarget& target = {});

template <class Row>
std::string html_table(const std::vector<Row>& rows,
                       const std::type_identity_t<std::vector<Column<Row>>>& columns,
                       const RowTarget& target = {}) {
  std::vector<std::string> headers;
  for (const Column<Row>& column : columns) headers.push_back(column.header());
  return html_table(
      headers, rows.size(),
      [&](std::size_t row, std::size_t column) { return columns[column].cell(rows[row]); }, target);
}

/// A <table>; the first row is its head. Cells are escaped. Precondition: all rows have the same size. New
/// code should use columns instead.
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// Folds `html` under a line that opens it, for details such as long tables. Initially closed.
std::string folded(std::string_view summary, std::string_view html);

/// The sentence that answers the page's question, in large letters at the top.
std::string answer(std::string_view sentence);

/// The badge of a picture on a page that states the origin of its simulated data.
inline constexpr const char* kSimulatedOnPage = "see the page";

/// The box with the origin of a page's simulated data; empty for real data.
std::string simulated_box(std::string_view by_what);

/// A complete document around `body`, with the style sheet inside.
std::string html_document(std::string_view title, std::string_view body);

}  // namespace tacto::analysis

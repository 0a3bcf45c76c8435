// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a self-contained HTML page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tacto::analysis {

/// Text with <, >, & and quotes written as entities; bytes that are no UTF-8 as U+FFFD.
std::string escaped(std::string_view text);

/// An <img> that holds its SVG as a data: URI; `alternative` is read where pictures can't be seen.
std::string inline_svg(std::string_view svg, std::string_view alternative);

/// A <table>; the first row is its head. Cells are escaped.
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// A whole document around `body`, with the house's style sheet inside.
std::string html_document(std::string_view title, std::string_view body);

}  // namespace tacto::analysis

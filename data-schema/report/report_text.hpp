// SPDX-License-Identifier: GPL-3.0-or-later
// A report as lines on a terminal, within a width and a number of lines.
#pragma once

#include <cstddef>
#include <string>

#include "data-schema/report/report.hpp"

namespace tacto::cli {

/// Columns that a terminal line may have, and lines in all; 0: any number.
struct TextLimits {
  std::size_t columns = 120;
  std::size_t lines = 0;
};

/// Texts wrap at spaces (a path without spaces is never broken); rows of a table that is too wide continue in
/// further lines, indented. If there are not enough lines, tables keep their first rows and columns, figures
/// their first lines, and the last line says how much is missing and that --json prints all of it.
std::string text_of(const Report& report, const TextLimits& limits);

/// As JSON on one line.
std::string json_line(const Report& report);

}  // namespace tacto::cli

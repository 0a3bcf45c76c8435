// SPDX-License-Identifier: GPL-3.0-or-later
// A report as lines of text: on a terminal within its width, and with tables of so many rows that it fits its
// height.
#pragma once

#include <cstddef>
#include <string>

#include "data-schema/report/report.hpp"

namespace tacto::cli {

/// `columns` of a line, 0: any number; `lines` of a terminal, 0: any number; `rows` of each table.
struct TextLimits {
  std::size_t columns = 0;
  std::size_t lines = 0;
  std::size_t rows = SIZE_MAX;
};

/// Texts wrap at spaces; a word without spaces, like a path, is never broken. A table that is too wide is
/// printed one row below the other. If the report has more than `limits.lines`, each table stops after its
/// first rows, five at least, and says how many more there are. Everything else is whole.
std::string text_of(const Report& report, const TextLimits& limits);

/// As JSON on one line.
std::string json_line(const Report& report);

}  // namespace tacto::cli

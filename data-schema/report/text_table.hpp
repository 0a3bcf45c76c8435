// SPDX-License-Identifier: GPL-3.0-or-later
// A table as lines of text within a given width.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tacto::cli {

using TextRow = std::vector<std::string>;

/// The text in lines no wider than `width`, broken at spaces; a longer word has a line of its own.
std::vector<std::string> wrapped_text(const std::string& text, std::size_t width);

/// Header and rows, all with the same number of cells, as aligned columns. If they are wider than `width` (0:
/// any), headers break at spaces and columns without values are left out; nullopt if they are still too wide.
std::optional<std::vector<std::string>> table_lines(TextRow header, std::vector<TextRow> rows,
                                                    std::size_t width);

}  // namespace tacto::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// A small table of numbers with named columns.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

struct NumberTable {
  std::vector<std::string> names;
  std::vector<double> values;      ///< row by row
  std::vector<std::size_t> lines;  ///< line of each row in the file, from 1

  std::size_t rows() const { return values.size() / names.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * names.size() + column]; }
};

/// Reads all columns as `import` does: any delimiter, decimal point or comma. Errors: not_found; malformed,
/// with line and column: NaN, text, a missing value, a ragged row, no header.
schema::Result<NumberTable> read_numbers(const std::string& path);

/// The header only. Errors: the same.
schema::Result<std::vector<std::string>> table_names(const std::string& path);

}  // namespace tacto::analysis

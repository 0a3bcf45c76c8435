// SPDX-License-Identifier: GPL-3.0-or-later
// A CSV of numbers with named columns, which a force layer names as its file. Internal to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

struct NumberRows {
  std::vector<double> cells;       ///< row by row, in the order of the columns asked for
  std::vector<std::size_t> lines;  ///< of each row in the file, from 1 on
};

/// What a row is, in messages: "atom", "node".
struct RowsAsked {
  std::span<const std::string_view> columns;
  std::size_t most_rows = 0;
  std::string_view row;
};

/// The first line names the columns, in any order. Empty lines and lines that begin with # are ignored.
/// Errors: not_found; malformed, with the line: a column that is missing, twice, or unknown (with the nearest
/// known one), a cell that is not a finite number, no row, too many.
Result<NumberRows> read_number_rows(const std::string& path, const RowsAsked& asked);

/// A fault of one line.
tl::unexpected<Error> fault_in_line(const std::string& path, std::size_t line, std::string what,
                                    std::string remedy);

}  // namespace tacto::schema

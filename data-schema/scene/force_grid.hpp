// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of a force_map layer, from a CSV.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

inline constexpr std::size_t kMostForceNodes = std::size_t{1} << 20;  ///< of a file: 1024 x 1024
inline constexpr double kMostNodeForce_n = 1000;

/// Forces on a hand at the nodes of a grid, row by row, rows along y.
struct ForceGrid {
  std::size_t columns = 0, rows = 0;
  double pitch_m = 0;                   ///< along both axes
  double first_x_m = 0, first_y_m = 0;  ///< of the first node
  std::vector<double> x_n, y_n;
};

/// A CSV whose first line names the columns x_m, y_m, fx_n, fy_n, in any order, and that has a line for each
/// node of the grid, in any order. Empty lines and lines that begin with # are ignored. Errors: those of
/// read_number_rows(); malformed: fewer than two nodes, a pitch that changes along an axis or differs between
/// them (by more than 1e-3), a node that is missing or appears twice, a force beyond kMostNodeForce_n.
Result<ForceGrid> read_force_grid(const std::string& path);

}  // namespace tacto::schema

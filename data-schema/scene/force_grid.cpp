// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/force_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "data-schema/scene/number_rows.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kNodeColumns[] = {"x_m", "y_m", "fx_n", "fy_n"};
constexpr std::size_t kColumns = std::size(kNodeColumns);
constexpr double kPitchTolerance = 1e-3;  // of the pitch: numbers of a file are rounded
constexpr const char* kPitchRemedy =
    "interpolate the forces on a grid of one pitch along x and y (SciPy: RegularGridInterpolator)";

// The places of the nodes along one axis: count places from `first_m` on, `pitch_m` apart.
struct NodeAxis {
  std::size_t count = 0;
  double first_m = 0, pitch_m = 0;  // 0: one place

  std::size_t index_of(double place_m) const {
    return count == 1 ? 0 : static_cast<std::size_t>(std::lround((place_m - first_m) / pitch_m));
  }
};

// Of column 0 or 1.
Result<NodeAxis> axis_of(const NumberRows& rows, std::size_t column, const std::string& path) {
  std::vector<double> places;
  for (std::size_t at = column; at < rows.cells.size(); at += kColumns) places.push_back(rows.cells[at]);
  std::ranges::sort(places);
  const double first = places.front(), span = places.back() - first;
  constexpr double kSame = 1e-7;  // of the length of the grid, which has at most 2^20 pitches
  const auto same = [&](double a, double b) { return b - a <= kSame * span; };
  places.erase(std::unique(places.begin(), places.end(), same), places.end());
  NodeAxis axis{places.size(), first, 0};
  if (axis.count == 1) return axis;
  axis.pitch_m = span / static_cast<double>(axis.count - 1);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (const double off_m = places[i] - (first + static_cast<double>(i) * axis.pitch_m);
        std::abs(off_m) > kPitchTolerance * axis.pitch_m)
      return fail(
          ErrorKind::malformed,
          fmt::format("its places along {} have no constant pitch: {:.9g} m is one of {} between {:.9g} m "
                      "and {:.9g} m",
                      kNodeColumns[column], places[i], axis.count, first, first + span),
          path, kPitchRemedy);
  return axis;
}

}  // namespace

Result<ForceGrid> read_force_grid(const std::string& path) {
  const auto rows = read_number_rows(path, {kNodeColumns, kMostForceNodes, "node"});
  TACTO_TRY(rows);
  const auto x = axis_of(*rows, 0, path);
  TACTO_TRY(x);
  const auto y = axis_of(*rows, 1, path);
  TACTO_TRY(y);
  const std::size_t nodes = x->count * y->count;
  if (nodes < 2)
    return fail(ErrorKind::malformed, "all its nodes are at one place", path, "a grid has two or more");
  if (x->count > 1 && y->count > 1 &&
      std::abs(x->pitch_m - y->pitch_m) > kPitchTolerance * std::min(x->pitch_m, y->pitch_m))
    return fail(ErrorKind::malformed,
                fmt::format("its pitch is {:.6g} m along x and {:.6g} m along y", x->pitch_m, y->pitch_m),
                path, kPitchRemedy);
  // More nodes than rows: at least one is missing; the numbers of a node stay NaN until they were read.
  if (nodes > rows->lines.size())
    return fail(ErrorKind::malformed,
                fmt::format("it has {} nodes, its grid of {} x {} has {}", rows->lines.size(), x->count,
                            y->count, nodes),
                path, "give each node of the grid a line; where nothing acts the force is 0");
  ForceGrid grid{x->count, y->count, std::max(x->pitch_m, y->pitch_m), x->first_m, y->first_m, {}, {}};
  grid.x_n.assign(nodes, NAN);
  grid.y_n.assign(nodes, NAN);
  for (std::size_t i = 0; i < rows->lines.size(); ++i) {
    const double* const cell = rows->cells.data() + i * kColumns;
    const std::size_t at = y->index_of(cell[1]) * x->count + x->index_of(cell[0]);
    if (!std::isnan(grid.x_n[at]))
      return fault_in_line(path, rows->lines[i],
                           fmt::format("the node at {:g} m, {:g} m appears twice", cell[0], cell[1]),
                           "keep one of the two");
    for (const double force_n : {cell[2], cell[3]})
      if (!(std::abs(force_n) <= kMostNodeForce_n))
        return fault_in_line(path, rows->lines[i], fmt::format("a force is {:g} N", force_n),
                             fmt::format("at most {:g} N; give it a unit of N", kMostNodeForce_n));
    grid.x_n[at] = cell[2];
    grid.y_n[at] = cell[3];
  }
  return grid;
}

}  // namespace tacto::schema

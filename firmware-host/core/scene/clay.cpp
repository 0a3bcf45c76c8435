// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/clay.hpp"

#include "firmware-host/core/scene/relief.hpp"

namespace tacto::core {
namespace {

// A point that sinks by this many parts d / 2, and the points that may get them, as places from the first
// grid point of the cell.
struct ClayPlace {
  int8_t x = 0, y = 0;
};
struct ClayPoint {
  ClayPlace from, to[2];
  int parts = 0;
};
struct ClayPattern {
  ClayPoint points[12];
};

// Of a quarter, which is turned around the middle of the cell.
constexpr ClayPattern whole_pattern() noexcept {
  constexpr ClayPoint kOfAQuarter[] = {
      {{1, 1}, {{3, 2}, {2, 3}}, 2}, {{2, 0}, {{3, 0}, {}}, 1}, {{2, 1}, {{3, 1}, {}}, 1}};
  const auto turn = [](ClayPlace& place) {
    const int8_t x = place.x;
    place.x = static_cast<int8_t>(1 - place.y), place.y = x;
  };
  ClayPattern whole{};
  int count = 0;
  for (ClayPoint point : kOfAQuarter)
    for (int quarter = 0; quarter < 4; ++quarter) {
      whole.points[count++] = point;
      turn(point.from), turn(point.to[0]), turn(point.to[1]);
    }
  return whole;
}
constexpr ClayPattern kPattern = whole_pattern();

// The grid points around one; beyond the edges the outermost ones continue, as in relief_at().
class ClayGrid {
 public:
  ClayGrid(const float* heights, const ReliefLevelTable& level, int32_t column, int32_t row) noexcept {
#pragma GCC unroll 1
    for (int i = 0; i < kSide; ++i) {
      columns_[i] = held(column + i - kBefore, level.columns);
      rows_[i] = heights + static_cast<size_t>(held(row + i - kBefore, level.rows)) * level.columns;
    }
  }
  float at(int x, int y) const noexcept { return rows_[y + kBefore][columns_[x + kBefore]]; }

 private:
  static constexpr int kBefore = 4, kSide = 10;
  static uint32_t held(int32_t index, uint32_t count) noexcept {
    return index < 0 ? 0 : static_cast<uint32_t>(index) < count ? static_cast<uint32_t>(index) : count - 1;
  }
  uint32_t columns_[kSide];
  const float* rows_[kSide];
};

// Of the differences from a point to the next one along x (dx = 1) or y (0), the largest change from place to
// place, absolute, on lines along the rows or the columns. Not inlined: flash is small.
[[gnu::noinline]] float largest_change(const ClayGrid& h, int first_line, int first, int last,
                                       bool along_rows, int dx) noexcept {
  float most = 0;
#pragma GCC unroll 1
  for (int line = first_line; line < last; ++line) {
    float before = 0;
#pragma GCC unroll 1
    for (int at = first; at <= last; ++at) {
      const int x = along_rows ? at : line, y = along_rows ? line : at;
      const float after = h.at(x + dx, y + 1 - dx) - h.at(x, y), size = __builtin_fabsf(after - before);
      most = at > first && size > most ? size : most;
      before = after;
    }
  }
  return most;
}

const float* heights_of(const ReliefPieceTable& table) noexcept {
  return coefficients_of(relief_of(table), levels_of(relief_of(table))[0]);
}

// Null beside the grid.
[[gnu::noinline]] float* height_at(float* heights, const ReliefLevelTable& level, const int32_t (&cell)[2],
                                   ClayPlace place) noexcept {
  const auto column = static_cast<uint32_t>(cell[0] + place.x),
             row = static_cast<uint32_t>(cell[1] + place.y);
  if (column >= level.columns || row >= level.rows) return nullptr;  // below 0: a large one
  return heights + static_cast<size_t>(row) * level.columns + column;
}

}  // namespace

// A second derivative of a B-spline surface is a mean of second differences of its coefficients; the largest
// one in any direction is at most the larger of those along the axes plus the mixed one (Gershgorin).
float clay_bend_per_m(const ReliefPieceTable& table, int32_t column, int32_t row, int reach) noexcept {
  const ReliefLevelTable& level = levels_of(relief_of(table))[0];
  const ClayGrid h(heights_of(table), level, column, row);
  const int end = reach + 2;
  float along_x = largest_change(h, -reach, -reach - 2, end, true, 1),
        along_y = largest_change(h, -reach, -reach - 2, end, false, 0);
  const float mixed = largest_change(h, -reach - 1, -reach - 1, end, false, 1);
  const float* const per_m = level.samples_per_m;
  along_x *= per_m[0] * per_m[0], along_y *= per_m[1] * per_m[1];
  return (along_x > along_y ? along_x : along_y) + per_m[0] * per_m[1] * mixed;
}

void press_clay(ReliefPieceTable& table, SpaceVector place) noexcept {
  const ReliefLevelTable& level = levels_of(relief_of(table))[0];
  const uint32_t counts[2] = {level.columns, level.rows};
  int32_t cell[2];
  for (int i = 0; i < 2; ++i) {
    const float* const axis = table.axes[i];
    const float along_m = axis[0] * place.x + axis[1] * place.y + axis[2] * place.z;
    cell[i] = lattice_place(place_from_centre(level, i, along_m + table.origin_m[i])).cell;
    if (cell[i] < 0 || static_cast<uint32_t>(cell[i]) + 1 >= counts[i]) return;
  }
  auto* const heights = const_cast<float*>(heights_of(table));
  const ClayTable& clay = table.clay;
#pragma GCC unroll 1
  for (const ClayPoint& point : kPattern.points) {
    const float sinks_m = static_cast<float>(point.parts) * clay.half_m;
    const int rising = clay.kept != 0 ? point.parts : 0;
    float *const from = height_at(heights, level, cell, point.from), *to[2] = {};
    bool moves = from != nullptr && *from - sinks_m >= clay.least_m;
#pragma GCC unroll 1
    for (int k = 0; k < rising; ++k) {
      to[k] = height_at(heights, level, cell, point.to[k]);
      moves = moves && to[k] != nullptr && *to[k] + clay.half_m <= clay.most_m;
    }
    if (!moves) continue;
    *from -= sinks_m;
    for (int k = 0; k < rising; ++k) *to[k] += clay.half_m;
  }
  const float bend_per_m = clay_bend_per_m(table, cell[0], cell[1], clay.kept != 0 ? 2 : 1);
  if (bend_per_m > table.bend_per_m) table.bend_per_m = bend_per_m;
}

}  // namespace tacto::core

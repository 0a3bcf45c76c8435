// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/clay.hpp"

#include "firmware-host/core/scene/relief.hpp"

namespace tacto::core {
namespace {

// A part d / 2 and where it goes, from the first grid point of the cell; of one side, the other three are
// turned by quarters around the middle of the cell.
struct ClayPart {
  int8_t from[2], to[2];
};
constexpr ClayPart kPartsOfASide[] = {
    {{1, 0}, {3, -1}}, {{1, 1}, {3, 2}}, {{2, 0}, {3, 0}}, {{2, 1}, {3, 1}}};

// The grid points around one; beyond the edges the outermost ones continue, as in relief_at().
class ClayGrid {
 public:
  ClayGrid(const float* heights, const ReliefLevelTable& level, int32_t column, int32_t row) noexcept {
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

void keep_larger(float& most, float value) noexcept {
  const float size = value < 0 ? -value : value;
  most = size > most ? size : most;
}

const float* heights_of(const ReliefPieceTable& table) noexcept {
  return coefficients_of(relief_of(table), levels_of(relief_of(table))[0]);
}

}  // namespace

// A second derivative of a B-spline surface is a mean of second differences of its coefficients; the largest
// one in any direction is at most the larger of those along the axes plus the mixed one (Gershgorin).
float clay_bend_per_m(const ReliefPieceTable& table, int32_t column, int32_t row, int reach) noexcept {
  const ReliefLevelTable& level = levels_of(relief_of(table))[0];
  const ClayGrid h(heights_of(table), level, column, row);
  float along_x = 0, along_y = 0, mixed = 0;
  const int end = reach + 1;
  for (int j = -reach; j <= end; ++j)
    for (int i = -reach - 1; i <= end + 1; ++i) {
      keep_larger(along_x, (h.at(i - 1, j) - h.at(i, j)) + (h.at(i + 1, j) - h.at(i, j)));
      keep_larger(along_y, (h.at(j, i - 1) - h.at(j, i)) + (h.at(j, i + 1) - h.at(j, i)));
    }
  for (int j = -reach - 1; j <= end; ++j)
    for (int i = -reach - 1; i <= end; ++i)
      keep_larger(mixed, (h.at(i + 1, j + 1) - h.at(i, j + 1)) - (h.at(i + 1, j) - h.at(i, j)));
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
  const auto height = [&](int x, int y) -> float* {
    const int32_t column = cell[0] + x, row = cell[1] + y;
    const bool there = column >= 0 && static_cast<uint32_t>(column) < level.columns && row >= 0 &&
                       static_cast<uint32_t>(row) < level.rows;
    return there ? heights + static_cast<size_t>(row) * level.columns + column : nullptr;
  };
  const ClayTable& clay = table.clay;
  for (const ClayPart& part : kPartsOfASide) {
    int x = part.from[0], y = part.from[1], to_x = part.to[0], to_y = part.to[1];
    for (int side = 0; side < 4; ++side) {
      float *const from = height(x, y), *const to = height(to_x, to_y);
      const bool sinks = from != nullptr && *from - clay.half_m >= clay.least_m,
                 rises = clay.kept == 0 || (to != nullptr && *to + clay.half_m <= clay.most_m);
      if (sinks && rises) {
        *from -= clay.half_m;
        if (clay.kept != 0) *to += clay.half_m;
      }
      const int turned_x = 1 - y, turned_to_x = 1 - to_y;
      y = x, x = turned_x, to_y = to_x, to_x = turned_to_x;
    }
  }
  const float bend_per_m = clay_bend_per_m(table, cell[0], cell[1], clay.kept != 0 ? 2 : 1);
  if (bend_per_m > table.bend_per_m) table.bend_per_m = bend_per_m;
}

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// A height map as a cubic B-spline surface, and the exact gradient of that surface.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "firmware-host/core/scene/lattice_place.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

/// Coefficients row by row; columns run along x. Beyond its edges the outermost coefficients continue.
struct ReliefLevel {
  const float* coefficients = nullptr;
  uint32_t columns = 0, rows = 0;
};

/// The finest of a pyramid's levels is used alone up to this frequency of its shortest period: the next one
/// is reached half an octave later, at half the rate.
inline constexpr float kWholeReliefPerTick = 0.35355339F;  ///< cycles: sqrt(1/2) / 2

struct ReliefSample {
  float value = 0;
  float by_x = 0, by_y = 0;  ///< derivatives, per sample
};

/// At a place in units of samples; (0, 0) is the first one. Sums are of differences from the coefficient
/// nearest to the place, so that a slope does not lose the digits of the height. Because the force is the
/// gradient of one surface, the work along a closed path is zero. Preconditions: coefficients set, at least
/// one row and column. Safe in the tick.
ReliefSample relief_at(const ReliefLevel& level, Q32 x, Q32 y) noexcept;

/// The same with the second derivatives, per sample^2. Preconditions and tick as above.
struct CurvedSample {
  float value = 0;
  float by_x = 0, by_y = 0, by_xx = 0, by_xy = 0, by_yy = 0;
};
CurvedSample curved_relief_at(const ReliefLevel& level, Q32 x, Q32 y) noexcept;

/// The place on a level, along its columns (0) or rows (1), from the centre of a map whose rows do not depend
/// on counts. Safe in the tick.
inline Q32 place_from_centre(const ReliefLevelTable& level, int axis, float from_centre_m) noexcept {
  const SceneRow& row = level.along[axis];
  return static_cast<Q32>(joined(row.whole, row.part) +
                          static_cast<uint64_t>(fixed_point(from_centre_m * level.samples_per_m[axis])));
}

/// The values at a place of two surfaces of one size; the coefficients of the other one are `second` behind
/// those of the level. Preconditions and tick as above.
void values_at(const ReliefLevel& level, size_t second, Q32 x, Q32 y, float (&values)[2]) noexcept;

/// The levels that are played at a speed: the first of two, and their weights.
struct PlayedLevels {
  uint32_t first = 0;
  float weights[2] = {1, 0};
};

/// A level is left when its highest frequency reaches half the rate. Safe in the tick.
PlayedLevels played_levels(const ReliefTable& table, float speed_mps, float rate_hz) noexcept;

/// The slope of the levels that are played, along the columns and rows of the map; `place_on(level, axis)`:
/// the place on a level along its columns (0) or rows (1). Safe in the tick.
template <class PlaceOn>
PlaneVector slope_of(const ReliefTable& table, const PlayedLevels& played, PlaceOn place_on) noexcept {
  PlaneVector slope;
  for (uint32_t i = 0; i < 2; ++i) {
    if (played.weights[i] == 0 || played.first + i >= table.levels) continue;
    const ReliefLevelTable& level = levels_of(table)[played.first + i];
    const ReliefSample at = relief_at({coefficients_of(table, level), level.columns, level.rows},
                                      place_on(level, 0), place_on(level, 1));
    slope.x += played.weights[i] * level.samples_per_m[0] * at.by_x;
    slope.y += played.weights[i] * level.samples_per_m[1] * at.by_y;
  }
  return slope;
}

}  // namespace tacto::core

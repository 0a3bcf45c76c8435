// SPDX-License-Identifier: Apache-2.0
// A height map as a cubic B-spline surface, and the exact gradient of that surface.
#pragma once

#include <stdint.h>

#include "firmware-host/core/scene/lattice_place.hpp"

namespace tacto::core {

/// Coefficients row by row; columns run along x. Beyond its edges the outermost coefficients continue.
struct ReliefLevel {
  const float* coefficients = nullptr;
  uint32_t columns = 0, rows = 0;
};

struct ReliefSample {
  float value = 0;
  float by_x = 0, by_y = 0;  ///< derivatives, per sample
};

/// At a place in units of samples; (0, 0) is the first one. Because the force is the gradient of one surface,
/// the work along a closed path is zero. Preconditions: coefficients set, at least one row and column. Safe
/// in the tick.
ReliefSample relief_at(const ReliefLevel& level, Q32 x, Q32 y) noexcept;

/// Between two levels: `fade` 0 is the finer one, 1 the coarser one, whose samples lie `ratio` times as far
/// apart.
ReliefSample mixed_relief(const ReliefSample& finer, const ReliefSample& coarser, float ratio,
                          float fade) noexcept;

}  // namespace tacto::core

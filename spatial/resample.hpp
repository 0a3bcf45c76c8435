// SPDX-License-Identifier: GPL-3.0-or-later
// f(x_i) = S_f(S_x^-1(x_i)): values over time to an even grid in space (Wiertlewski 2011, its chain's second
// step).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/signal.hpp"
#include "spatial/monotone_path.hpp"

namespace tacto::spatial {

/// Positions (first + i) pitch_m on the bench, i = 0 ... count - 1.
struct SpaceGrid {
  double pitch_m = 1e-6;
  double first = 0;
  std::size_t count = 0;
  double origin_m() const { return first * pitch_m; }
  double position_m(std::size_t i) const { return (first + static_cast<double>(i)) * pitch_m; }
};

/// The multiples of the pitch that the path covers. Errors: unsuitable, where it covers none but one, and for
/// more than 1e9 samples.
schema::Result<SpaceGrid> grid_along(const MonotonePath& path, int direction, double pitch_m);

/// Values at the grid's positions, by growing position. values[i] belongs to sample i - margin of the path's
/// time: a margin of 2 samples or more beyond the path makes the slopes at its ends those of the whole
/// signal.
std::vector<double> resample(const MonotonePath& path, int direction, const SpaceGrid& grid,
                             std::span<const double> values, std::size_t margin);

}  // namespace tacto::spatial

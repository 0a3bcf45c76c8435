// SPDX-License-Identifier: GPL-3.0-or-later
// Discrete cosine transforms of a grid. Offline use; planning locks a mutex, so it is not safe in the tick.
#pragma once

#include <cstddef>
#include <span>

namespace tacto::spatial {

/// Rows one after the other.
struct GridSize {
  std::size_t columns = 0, rows = 0;
};

/// In place, X_kl = sum_ij x_ij cos(pi k (i + 1/2) / columns) cos(pi l (j + 1/2) / rows): the spectrum of the
/// grid continued evenly beyond its edges (DCT-II along both axes). The frequency of k is k / (2 columns)
/// cycles per sample.
void to_cosines(std::span<double> values, GridSize size);

/// The inverse: from_cosines(to_cosines(x)) = x. With the first coefficients of another grid, or zeros behind
/// them, times the ratio of the numbers of places, it gives the same continuous surface on this grid.
void from_cosines(std::span<double> values, GridSize size);

}  // namespace tacto::spatial

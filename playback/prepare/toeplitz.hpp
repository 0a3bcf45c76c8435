// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric Toeplitz systems of linear equations.
#pragma once

#include <span>
#include <vector>

namespace tacto::playback {

/// Solves sum_j row[|i - j|] x_j = right_i by Cholesky factorisation of the whole matrix (n^3 / 6).
/// Levinson's algorithm (n^2) loses digits at a condition of 1e10, which is usual for a filter. Positive
/// definite; equal sizes.
std::vector<double> solve_toeplitz(std::span<const double> row, std::span<const double> right);

}  // namespace tacto::playback

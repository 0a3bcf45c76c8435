// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric Toeplitz systems of linear equations.
#pragma once

#include <span>
#include <vector>

namespace tacto::playback {

/// x of sum_j row[|i - j|] x_j = right_i, by Cholesky's factorisation of the whole matrix (n^3 / 6:
/// Levinson's n^2 loses digits where the condition is 1e10, as a filter's is). Positive definite; equal
/// sizes.
std::vector<double> solve_toeplitz(std::span<const double> row, std::span<const double> right);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// The B-spline coefficients of a height map, computed before playback.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::playback {

/// Coefficients of the cubic B-spline surface that goes through all heights, in the heights' order (row by
/// row), with the outermost coefficients continued beyond the edges, as core::relief_at() does. Solves one
/// tridiagonal system per row and column in double precision. Precondition: heights.size() = columns x rows,
/// both at least 1.
std::vector<float> relief_coefficients(std::span<const double> heights, std::size_t columns,
                                       std::size_t rows);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// Middle values and lines that a few outliers do not move.
#pragma once

#include <span>
#include <vector>

namespace tacto::spatial {

/// The middle value, of an even number the upper of the two; reorders the values. NaN where there is none.
template <class Value>
double median_of(std::vector<Value>& values);

/// Slope of a line through points: the median of the slopes between all pairs (Theil 1950, Sen 1968). 0 where
/// no two points differ in x. Precondition: x and y of equal size. Cost: the square of their number.
double robust_slope(std::span<const double> x, std::span<const double> y);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// Medians and regression lines that are robust against outliers.
#pragma once

#include <span>
#include <vector>

namespace tacto::spatial {

/// The median; of an even number of values the upper one of the two. Reorders the values. NaN if there are
/// none.
template <class Value>
double median_of(std::vector<Value>& values);

/// Slope of a line through points: the median of the slopes between all pairs (Theil 1950, Sen 1968). 0 if no
/// two points differ in x. Precondition: x and y of equal size. Cost: the square of their number.
double robust_slope(std::span<const double> x, std::span<const double> y);

}  // namespace tacto::spatial

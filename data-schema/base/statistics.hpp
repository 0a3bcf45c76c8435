// SPDX-License-Identifier: GPL-3.0-or-later
// Median, RMS and Student's t, for all rooms.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace tacto::schema {

/// The middle value; of an even number of values the upper of the two. Reorders the values. Precondition: at
/// least one value.
template <class Value>
Value upper_median(std::span<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// NaN of no values.
double rms_of(std::span<const double> values);

/// Quantile of Student's t distribution; of the normal one for infinite freedom. Freedom below 1 counts as 1.
/// NaN for a freedom that is NaN. Precondition: 0 < probability < 1.
double student_t(double freedom, double probability);

inline constexpr double kTwoSided95 = 0.975, kOneSided95 = 0.95;  ///< probabilities for student_t()

}  // namespace tacto::schema

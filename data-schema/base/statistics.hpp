// SPDX-License-Identifier: GPL-3.0-or-later
// Median and Student's t, for all rooms.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace tacto::schema {

inline constexpr double kNormal95 = 1.959964;          ///< of the normal distribution, 95 %, two-sided
inline constexpr double kNormal95OneSided = 1.644854;  ///< the same, one-sided

/// The middle value; of an even number of values the upper of the two. Reorders the values. Precondition: at
/// least one value.
template <class Value>
Value upper_median(std::span<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Quantile of Student's t at the probability of the normal distribution's quantile `normal`, by the series
/// of Cornish and Fisher in 1/freedom (Abramowitz and Stegun 26.7.5). Two-sided 95 %: within 0.2 % from 3
/// degrees of freedom on, exact for 1 and 2.
double student_t(double freedom, double normal);

}  // namespace tacto::schema

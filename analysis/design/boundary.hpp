// SPDX-License-Identifier: GPL-3.0-or-later
// Where a condition on a positive number begins or ceases to hold, by steps and bisection.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

namespace tacto::analysis {

inline constexpr double kBoundaryStep = 1.5;
inline constexpr int kBisections = 35;  // 0.4 / 2^35: to 1e-11

template <class Good>
double bisected(double good_at, double bad_at, const Good& good) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = std::sqrt(good_at * bad_at);
    (good(middle) ? good_at : bad_at) = middle;
  }
  return good_at;
}

/// The number up to which `good` holds, from `start` upwards or downwards: infinity above `highest`, 0 below
/// `lowest`.
template <class Good>
double last_good(double start, double lowest, double highest, const Good& good) {
  double inside = start;
  if (good(start)) {
    while (good(inside * kBoundaryStep)) {
      inside *= kBoundaryStep;
      if (inside > highest) return std::numeric_limits<double>::infinity();
    }
    return bisected(inside, inside * kBoundaryStep, good);
  }
  while (inside >= lowest) {
    inside /= kBoundaryStep;
    if (good(inside)) return bisected(inside, inside * kBoundaryStep, good);
  }
  return 0;
}

/// The smallest number above `start`, where it does not hold, from which on `good` holds.
template <class Good>
std::optional<double> first_above(double start, double highest, const Good& good) {
  for (double inside = start * kBoundaryStep; inside <= highest; inside *= kBoundaryStep)
    if (good(inside)) return bisected(inside, inside / kBoundaryStep, good);
  return std::nullopt;
}

}  // namespace tacto::analysis

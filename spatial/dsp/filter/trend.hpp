// SPDX-License-Identifier: GPL-3.0-or-later
// The least-squares straight line of a section of samples, and their largest distance from the mean.
#pragma once

#include <span>

namespace tacto::spatial {

struct Trend {
  double mean = 0;
  double slope = 0;    ///< per sample, by least squares
  double largest = 0;  ///< largest |x - mean|
};

/// Precondition: at least two values. Sums are relative to the first value, so that a large baseline costs no
/// digits.
Trend trend_of(std::span<const double> values);

/// sum (x - level).
double sum_above(std::span<const double> values, double level);

/// out_i = (x_i - level - slope i) scale, in double precision except for the result. Sizes are equal.
void subtract_line(std::span<const double> values, double level, double slope, double scale,
                   std::span<float> out);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// The straight line that fits a stretch of samples best, and how far they lie from their mean.
#pragma once

#include <span>

namespace tacto::spatial {

struct Trend {
  double mean = 0;
  double slope = 0;    ///< a sample, by least squares
  double largest = 0;  ///< |x - mean| at most
};

/// Precondition: at least two values. Sums are taken over the first value, so that a strong baseline costs no
/// digits.
Trend trend_of(std::span<const double> values);

/// sum (x - level).
double sum_above(std::span<const double> values, double level);

/// out_i = (x_i - level - slope i) scale, in double precision but for the result. Sizes are equal.
void take_off_line(std::span<const double> values, double level, double slope, double scale,
                   std::span<float> out);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// A number with how well it is known, after the Guide to the expression of uncertainty (JCGM 100:2008).
#pragma once

#include <limits>
#include <span>

namespace tacto::capture {

struct Uncertain {
  double value = 0;
  double uncertainty = 0;  ///< standard, k = 1
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};

/// By how much a standard uncertainty is multiplied for an interval of 95 %: Student's t, exact for 1 and 2
/// degrees of freedom, else Fisher and Cornish's series in 1/nu (Abramowitz and Stegun 26.7.5), within 0.2 %.
double coverage_factor_95(double degrees_of_freedom);

/// The mean of samples whose noise may be correlated over up to a twentieth of them: from the scatter of the
/// means of 20 equal blocks (type A, 19 degrees of freedom), and the numbers' own step (type B): a
/// rectangle, step / sqrt(12), where nothing moves, and exp(-2 pi^2 s^2 / step^2) of it under noise of
/// standard deviation s, which dithers it away (Widrow and Kollar, Quantization Noise, 2008, chapter 4).
/// Samples left over at the end are not used. Precondition: at least 20 samples.
Uncertain mean_of(std::span<const double> samples);

/// The largest step that all numbers are whole multiples of from each other: a converter's or counter's.
/// Where they are all the same, their lowest bit (a converter's codes are left-justified), 0 for zeros; 1
/// where they are no whole numbers.
double step_of(std::span<const double> samples);

/// The scatter of those blocks' means against that of the samples within them; for white noise, one over the
/// root of a block's length. 0 for a constant.
double drift_ratio(std::span<const double> samples);

}  // namespace tacto::capture

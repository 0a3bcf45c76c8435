// SPDX-License-Identifier: GPL-3.0-or-later
// A number with its uncertainty, after the Guide to the expression of uncertainty (JCGM 100:2008).
#pragma once

#include <limits>
#include <span>

namespace tacto::capture {

struct Uncertain {
  double value = 0;
  double uncertainty = 0;  ///< standard, k = 1
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};

/// The factor from a standard uncertainty to a 95 % interval: Student's t.
double coverage_factor_95(double degrees_of_freedom);

/// The mean of samples whose noise may be correlated over up to a twentieth of them. Type A: from the scatter
/// of the means of 20 equal blocks (19 degrees of freedom). Type B: from the quantisation step; step /
/// sqrt(12) for a constant signal, and exp(-2 pi^2 s^2 / step^2) of that with noise of standard deviation s,
/// which acts as dither (Widrow and Kollar, Quantization Noise, 2008, chapter 4). Samples that do not fill a
/// block are not used. Precondition: at least 20 samples.
Uncertain mean_of(std::span<const double> samples);

/// The largest step that divides all differences between the numbers: the step of a converter or counter. If
/// all numbers are equal, their lowest bit (converter codes are left-justified), 0 for zeros. 1 if they are
/// not integers.
double step_of(std::span<const double> samples);

/// The scatter of the means of those blocks relative to the scatter of the samples within the blocks; for
/// white noise, one over the square root of the block's length. 0 for a constant.
double drift_ratio(std::span<const double> samples);

}  // namespace tacto::capture

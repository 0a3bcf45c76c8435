// SPDX-License-Identifier: GPL-3.0-or-later
// The period of a texture that repeats itself.
#pragma once

#include <optional>
#include <span>

namespace tacto::spatial {

/// In samples.
struct Period {
  double samples = 0;
  double correlation = 0;  ///< of the texture with itself, one period on
};

/// The correlation from which a texture has a period: a tenth of its power may be different.
inline constexpr double kLeastPeriodCorrelation = 0.9;

/// The shortest lag at which the values, about their mean, correlate with themselves as well as at any other,
/// at most half their number and by at least kLeastPeriodCorrelation; refined over the largest multiple that
/// fits. Error for a sinusoid of 10 periods: below 1e-6 of the period; with noise of 10 % of its RMS below
/// 1e-3. Nothing if there is none.
std::optional<Period> find_period(std::span<const double> values);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// The period of a texture that repeats itself.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tacto::spatial {

/// The values minus their mean.
std::vector<double> about_mean(std::span<const double> values);

/// The correlation from which a texture has a period: a tenth of its power may be different.
inline constexpr double kLeastPeriodCorrelation = 0.9;

/// The period in samples: the shortest lag at which the values, about their mean, correlate with themselves
/// as well as at any other one up to half their number, and by at least kLeastPeriodCorrelation; refined by
/// least squares over the largest multiple of it that fits. Error for lines up to a hundredth of the samples
/// per metre over ten periods: below 3e-6 of the period; with noise of 10 % of their RMS, 1e-4. A period of
/// less than some ten samples may be found as a multiple of itself. Nothing if there is none.
std::optional<double> find_period(std::span<const double> values);

/// Whether so many samples are whole periods, at least two, so that their end continues with their beginning.
bool is_whole_periods(std::size_t size, double period);

}  // namespace tacto::spatial

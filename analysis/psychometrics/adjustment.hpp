// SPDX-License-Identifier: GPL-3.0-or-later
// Means of settings by the method of adjustment, and the difference between ascending and descending series.
#pragma once

#include <optional>
#include <span>

#include "analysis/psychometrics/psychometric_fit.hpp"

namespace tacto::analysis {

struct SeriesMean {
  std::size_t settings = 0;
  Estimate ratio;                      ///< geometric_mean() of the settings
  std::optional<double> deviation_db;  ///< standard deviation of the levels; none: one setting
};

struct AdjustmentMeans {
  std::optional<SeriesMean> ascending, descending;  ///< none: no settings
  /// The middle of both means in dB, as a ratio, and descending minus ascending. Intervals of 95 % with the
  /// degrees of freedom of Welch 1947, and without limits if a series has only one setting. None: a series
  /// has no settings.
  std::optional<Estimate> middle, hysteresis_db;
};

/// `ascending`, `descending`: the ratios that were accepted, each above 0. Their levels in dB are the normal
/// variable. Pure.
AdjustmentMeans adjustment_means(std::span<const double> ascending, std::span<const double> descending);

}  // namespace tacto::analysis

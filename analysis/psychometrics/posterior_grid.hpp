// SPDX-License-Identifier: GPL-3.0-or-later
// Marginal intervals of a psychometric function's parameters. Internal to this folder.
#pragma once

#include "analysis/psychometrics/psychometric_likelihood.hpp"

namespace tacto::analysis {

/// The levels that the prior of threshold and width refers to (Schuett 2016), in scaled levels.
struct LevelRange {
  double least = 0, most = 0;
  double spacing = 0;  ///< the smallest between neighbours, at most a quarter of the range

  double range() const { return most - least; }
};

struct Interval {
  double low = 0, high = 0;
};

struct PosteriorIntervals {
  Interval centre, spread;              ///< 2.5 to 97.5 %
  double lapse_high = 0, eta_high = 0;  ///< 95 %
};

/// Integrates the posterior on a grid around its peak.
PosteriorIntervals posterior_intervals(const PsychometricLikelihood& likelihood, const LevelRange& range,
                                       const PsychometricPeak& peak);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Marginal intervals of a psychometric function's parameters. Internal to this folder.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "analysis/psychometrics/psychometric_fit.hpp"

namespace tacto::analysis {

// The probability of counts of answers, given a psychometric function. Internal to this folder.

/// The logarithm of likelihood times the priors of lapse and overdispersion, without constants.
class PsychometricLikelihood {
 public:
  /// Both must outlive it. Levels: as in PsychometricFit.
  PsychometricLikelihood(std::span<const LevelCount> levels, const PsychometricOptions& options);

  using Tails = std::vector<std::pair<double, double>>;
  /// F and 1 - F at each level.
  Tails tails(double centre, double spread) const;
  /// `eta` of 0: binomial answers.
  double at(const Tails& tails, double lapse, double eta) const;

  const std::vector<double>& scaled_levels() const { return scaled_; }
  const PsychometricOptions& options() const { return options_; }

 private:
  std::span<const LevelCount> levels_;
  const PsychometricOptions& options_;
  std::vector<double> scaled_;
};

/// The place of the maximum.
struct PsychometricPeak {
  double centre = 0, log_spread = 0, lapse = 0, eta = 0;
  double value = 0;
};

/// The limits of lapse (less than half of what guessing leaves) and of eta.
double most_lapse(const PsychometricOptions& options);
inline constexpr double kMostEta = 0.7;

/// Maximum over centre and spread by Newton's method, inside it over lapse and eta by Brent's.
PsychometricPeak peak_of(const PsychometricLikelihood& likelihood);

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

// SPDX-License-Identifier: GPL-3.0-or-later
// Fits a psychometric function to counts of answers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometrics/psychometric_function.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// The answers at one level: `yes` of `trials` were "yes", "correct", "more".
struct LevelCount {
  double level = 0;
  double yes = 0, trials = 0;
};

struct PsychometricOptions {
  Shape shape = Shape::normal;
  std::optional<double> guess = {};  ///< as in PsychometricFunction
  std::optional<double> lapse = {};  ///< fixed; without it fitted, with the prior Beta(1, 19)
  bool overdispersed = false;        ///< answers at one level scatter more than binomially
  /// Level at which F is 0.5, fixed; without it fitted. Levels on one side of it are enough then.
  std::optional<double> threshold = {};
};

/// A value with its 95 % interval.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// The most probable function and what the answers say about it.
struct PsychometricFit {
  PsychometricFunction function;
  std::vector<LevelCount> levels;  ///< ascending, each level once
  Estimate threshold;              ///< level at which F is 0.5
  Estimate spread;                 ///< of the function
  double lapse_high = 0;           ///< upper end of the one-sided 95 % interval
  double overdispersion = 0;       ///< eta: the variance is 1 + (trials - 1) eta^2 times the binomial one
  double overdispersion_high = 0;  ///< as lapse_high
  double deviance = 0;             ///< against the proportions themselves
  std::size_t freedom = 0;
  double p = 1;                    ///< of a deviance this large, if the function is right (chi-squared)
  std::vector<std::string> notes;  ///< for people: what limits the intervals
};

/// Estimates: the maximum of the likelihood times the priors of lapse and overdispersion, Beta(1, 19) and
/// Beta(1, 10). Intervals: quantiles of the marginal posterior, with the priors of threshold and width of
/// Schuett, Harmeling, Macke, Wichmann 2016 (Vision Research 122): flat in the range that the levels can
/// show, zero beyond it. Overdispersed answers are beta-binomial. Errors: unsuitable: fewer than two levels,
/// answers all alike (a bound), a step between two levels or at one, the only one at which both answers occur
/// (a bound: the smaller the spread, the better it fits), answers that don't rise with the level, a level
/// that is not above 0 for Weibull. With a fixed threshold (not of a Weibull function) an answer is right if
/// it is 'yes' above it or not below it, errors are: all answers right but lapses, or no more than half of
/// them; and the priors refer to the levels and their mirror images at the threshold. Precondition: 0 <= yes
/// <= trials, trials > 0, 0 <= guess < 1, 0 <= lapse < (1 - guess) / 2. Pure; takes milliseconds,
/// overdispersed about a second.
schema::Result<PsychometricFit> fit_psychometric(std::vector<LevelCount> levels,
                                                 const PsychometricOptions& options);

/// The function of fit_psychometric() without its intervals, which take most of the time. Errors: the same.
schema::Result<PsychometricFunction> most_probable_function(std::vector<LevelCount> levels,
                                                            const PsychometricOptions& options);

}  // namespace tacto::analysis

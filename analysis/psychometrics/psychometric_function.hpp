// SPDX-License-Identifier: GPL-3.0-or-later
// The probability of an answer against the level of a stimulus.
#pragma once

#include <optional>
#include <utility>

namespace tacto::analysis {

enum class Shape {
  normal,    ///< cumulative normal distribution
  logistic,  ///< logistic distribution
  weibull,   ///< Weibull distribution: levels above 0
};

/// p(level) = low + (1 - low - lapse) F(z), z = (x - centre) / spread, F(0) = 0.5. x is the level; for
/// Weibull its natural logarithm, so that spread is 1 / exponent. `low` is the rate of guessing, where one is
/// right by guessing; without it the task compares two stimuli, and lapses raise the lower end as much as
/// they reduce the upper one (Watson 2017, J. of Vision 17(3):10). Pure; safe anywhere.
struct PsychometricFunction {
  Shape shape = Shape::normal;
  double centre = 0, spread = 1;
  double lapse = 0;  ///< distance of the upper end from 1
  std::optional<double> guess = {};

  double low() const { return guess.value_or(lapse); }
  double operator()(double level) const;
  /// The level at which F is `part`, 0 < part < 1.
  double level_at(double part) const;
};

/// x of a level, and its inverse.
double scaled_level(Shape shape, double level);
double level_of(Shape shape, double scaled);

/// F(z) and 1 - F(z), both without cancellation.
std::pair<double, double> standard_function(Shape shape, double z);
/// z at which F is `part`.
double standard_quantile(Shape shape, double part);

}  // namespace tacto::analysis

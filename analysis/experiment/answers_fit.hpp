// SPDX-License-Identifier: GPL-3.0-or-later
// Psychometric functions of the groups of a table, and their comparison over people.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/answers_table.hpp"
#include "analysis/psychometrics/over_people.hpp"

namespace tacto::analysis {

/// How steep the function is: its JND (threshold to F = 0.75) where stimuli are compared, its width (F = 0.05
/// to 0.95) where one guesses, the exponent of a Weibull function.
struct FittedGroup {
  std::vector<std::string> by;
  PsychometricFit fit;
  Estimate steepness;
};

/// One condition: the steepness of each of its people.
struct ConditionOverPeople {
  std::vector<std::string> condition;
  std::vector<std::string> people;
  std::vector<double> figures;
  double mean = 0;     ///< arithmetic
  Estimate geometric;  ///< with the interval by Student's t on the logarithms
};

struct OverPeople {
  std::vector<ConditionOverPeople> conditions;
  std::optional<PairedTest> test;  ///< of two conditions with the same people
};

struct AnswersFit {
  AnswersTable table;
  PsychometricOptions options;                 ///< as used
  std::string threshold_name, steepness_name;  ///< "PSE", "JND" ...
  std::string steepness_unit;                  ///< that of the levels, or empty
  std::vector<FittedGroup> groups;
  std::vector<std::string> not_fitted;       ///< "P01: why", of a study
  std::optional<OverPeople> over_people;     ///< if there are several groups
  std::optional<OverPeople> without_lapses;  ///< the same with the lapse fixed at 0, if it was fitted
};

/// Fits each group, at the table's PSE if that is known. The first column of `by` is the person, the others
/// are conditions. Errors: those of fit_psychometric(), with the group; of a study only if no person can be
/// fitted. `tell` receives 0 to 1.
schema::Result<AnswersFit> fit_answers(AnswersTable table, PsychometricOptions options,
                                       const std::function<void(double)>& tell);

/// "S1, 0", or "all" without columns.
std::string group_name(const std::vector<std::string>& by);

}  // namespace tacto::analysis

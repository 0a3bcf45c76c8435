// SPDX-License-Identifier: GPL-3.0-or-later
// Answers of people from a table of another program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometrics/preference_scale.hpp"
#include "analysis/psychometrics/psychometric_fit.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Names of columns; empty: found (see read_answers).
struct AnswerColumns {
  std::string level, yes, no, trials;
  std::vector<std::string> by;  ///< the first is the person
};

/// The rows with the same texts in the columns `by`.
template <class Row>
struct AnswerGroup {
  std::vector<std::string> by;
  std::vector<Row> rows;
};

struct AnswersTable {
  AnswerColumns columns;                        ///< as used
  std::string level_name, unit;                 ///< of the level; without its unit, which may be empty
  std::vector<AnswerGroup<LevelCount>> groups;  ///< in the order of their texts, numbers by value
  std::string simulated;                        ///< by what, where an answer or a session is simulated
  std::vector<std::string> reversals = {};      ///< of staircases, their mean, in words
  std::optional<double> pse =
      {};                 ///< known, and not fitted: levels of one sign cannot separate it from the JND
  bool of_study = false;  ///< a person who cannot be fitted is left out, and does not prevent the others
};

/// Reads counts of answers against levels. Without names of columns, those that are not in `by` are, in this
/// order: level; "yes" (correct, faster); and, where there is a third, the other answer, or the number of
/// trials if its name is trials, n, total or count. Without a third each row is one trial, with 0 or 1.
/// Errors: those of reading the table; usage: a column that does not exist, columns without a role;
/// malformed, with line and column: a count that is not a whole number, or larger than the number of trials.
schema::Result<AnswersTable> read_answers(const std::string& file, const AnswerColumns& columns);

/// Reads preferences: columns `winner` and `loser`, and the number of times in `count`. Errors: as
/// read_answers().
schema::Result<std::vector<AnswerGroup<Preference>>> read_preferences(const std::string& file,
                                                                      const std::vector<std::string>& by);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of an identification: confusion matrices, success, transmitted information.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/answers_page.hpp"
#include "analysis/experiment/proof.hpp"
#include "analysis/psychometrics/confusion.hpp"

namespace tacto::analysis {

/// What one participant answered in one block.
struct BlockAnswers {
  std::string participant, condition;      ///< "real", "virtual"
  int block = 0;                           ///< 1: the participant's first block
  ConfusionMatrix matrix;                  ///< a row per comparison, a column per standard
  double trials = 0, success = 0;          ///< share of right answers
  std::optional<Information> information;  ///< none: a comparison with fewer than two answers
};

struct IdentificationAnswers {
  std::vector<std::string> comparisons, standards;
  std::vector<BlockAnswers> blocks;
  std::size_t abandoned = 0, timed_out = 0;  ///< trials without an answer, as TrialQueue counts them
  std::string simulated;
};

/// Of the trials that were delivered, or placed as real samples, and answered. Precondition: at least one
/// run, all of one identification.
IdentificationAnswers identification_answers(const std::vector<Run>& runs);

/// The people in one condition: mean and standard deviation of their success, mean of their
/// information, and the sum of their matrices.
struct BlocksOverPeople {
  std::string condition;
  std::size_t people = 0;
  double success = 0;
  std::optional<double> success_deviation;  ///< none: one person
  std::optional<Information> information;   ///< none: one of the people has none
  ConfusionMatrix matrix;
};
std::vector<BlocksOverPeople> blocks_over_people(const IdentificationAnswers& answers);

Findings findings_of(const IdentificationAnswers& answers);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of the task fidelity: how often a played texture is called the same as the sample beside it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/answers_page.hpp"
#include "analysis/experiment/proof.hpp"
#include "analysis/psychometrics/alternatives.hpp"

namespace tacto::analysis {

struct FidelityPerson {
  std::string participant;
  SameAnswers answers;
  std::optional<Estimate> d_prime;  ///< none: no answers beside its own, or beside another sample
};

struct FidelityAnswers {
  std::vector<std::string> standards;
  std::vector<FidelityPerson> people;
  /// Of all people, the answers of one played texture (first index) beside one sample (second).
  std::vector<std::vector<SameAnswers>> pairs;
  /// Of one person; of two or more the mean over those who have one, with Student's interval.
  std::optional<Estimate> d_prime;
  std::optional<double> predicted_error_db;  ///< median over the trials, of the worst stroke of each
  std::size_t abandoned = 0;
  std::string simulated;
};

/// Of the trials that were delivered and answered. Precondition: at least one run, all of one fidelity.
FidelityAnswers fidelity_answers(const std::vector<Run>& runs);

/// Of all people.
SameAnswers sum_of(const FidelityAnswers& answers);

Findings findings_of(const FidelityAnswers& answers);

}  // namespace tacto::analysis

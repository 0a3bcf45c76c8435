// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of the task ordering: mean ranks, agreement within and between people, and with a parameter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/answers_page.hpp"
#include "analysis/experiment/proof.hpp"
#include "analysis/psychometrics/concordance.hpp"

namespace tacto::analysis {

/// Correlation of mean ranks with the intended parameter.
struct RankCorrelation {
  double rho = 0, tau = 0;  ///< Spearman's, Kendall's tau-b
};

struct OrderedBy {
  std::string participant;  ///< empty: all
  std::size_t orders = 0;
  std::vector<double> mean_ranks;  ///< of each standard, from 1, the least
  /// Kendall's W of this person's orders, if there are two or more; of all: of the people's mean ranks.
  std::optional<Concordance> agreement;
  std::optional<RankCorrelation> intended;  ///< none: no parameter, or only ties
};

struct OrderingAnswers {
  std::vector<std::string> standards;
  std::vector<double> intended;
  std::vector<OrderedBy> people;
  OrderedBy all;  ///< mean over people
  std::size_t abandoned = 0;
  std::string simulated;
};

/// Of the trials that were delivered and answered. Precondition: at least one run, all of one ordering.
OrderingAnswers ordering_answers(const std::vector<Run>& runs);

Findings findings_of(const OrderingAnswers& answers);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Agreement of several people who put the same items in order: Kendall's W.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::analysis {

struct Concordance {
  double w = 0;            ///< 0: no agreement, 1: the same order
  double chi_squared = 0;  ///< Friedman's statistic, people (items - 1) W
  std::size_t freedom = 0;
  double p = 1;  ///< of a value this large, if the orders are random (chi-squared distribution)
};

/// `scores`: a row per person, a column per item; ranked within each row, ties get their mean rank and the
/// correction of Kendall 1945. Rows whose values are all equal leave W at 0. Precondition: two rows and two
/// columns or more, rows of equal length. Pure.
Concordance concordance_of(const std::vector<std::vector<double>>& scores);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Ranks: the agreement of several people who put the same items in order, and that of two orders.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
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

/// The rank of each value, from 1; ties get their mean rank. Pure.
std::vector<double> ranks_of(std::span<const double> values);

/// Spearman's rho: the correlation of the ranks. None: one of them has only equal values. Precondition: equal
/// lengths. Pure.
std::optional<double> spearman_rho(std::span<const double> a, std::span<const double> b);
/// Kendall's tau-b. As above.
std::optional<double> kendall_tau(std::span<const double> a, std::span<const double> b);

}  // namespace tacto::analysis

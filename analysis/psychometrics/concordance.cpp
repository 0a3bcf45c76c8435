// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/concordance.hpp"

#include <algorithm>

#include "analysis/psychometrics/deviance.hpp"

namespace tacto::analysis {
namespace {

// Adds the row's mean ranks to `sums` and gives the sum of t^3 - t over its ties.
double add_ranks(const std::vector<double>& row, std::vector<double>& sums) {
  double ties = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto below = static_cast<double>(std::ranges::count_if(row, [&](double x) { return x < row[i]; }));
    const auto equal = static_cast<double>(std::ranges::count(row, row[i]));
    sums[i] += below + (equal + 1) / 2;
    ties += equal * equal - 1;
  }
  return ties;
}

}  // namespace

Concordance concordance_of(const std::vector<std::vector<double>>& scores) {
  const auto people = static_cast<double>(scores.size()), items = static_cast<double>(scores.front().size());
  std::vector<double> sums(scores.front().size(), 0);
  double ties = 0, squares = 0;
  for (const auto& row : scores) ties += add_ranks(row, sums);
  for (const double sum : sums)
    squares += (sum - people * (items + 1) / 2) * (sum - people * (items + 1) / 2);
  Concordance found;
  found.freedom = scores.front().size() - 1;
  const double most = people * people * (items * items * items - items) - people * ties;
  if (most <= 0) return found;
  found.w = 12 * squares / most;
  found.chi_squared = people * (items - 1) * found.w;
  found.p = chi_squared_p(found.chi_squared, found.freedom);
  return found;
}

}  // namespace tacto::analysis

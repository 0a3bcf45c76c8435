// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/concordance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "analysis/psychometrics/deviance.hpp"

namespace tacto::analysis {
namespace {

// -1, 0 or 1; means of ranks that differ by rounding are equal.
int order_of(double a, double b) {
  constexpr double kRounding = 1e-12;
  if (std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b))) return 0;
  return a < b ? -1 : 1;
}

// The sum of t^3 - t over ties.
double ties_of(std::span<const double> row) {
  double ties = 0;
  for (const double value : row) {
    const auto equal =
        static_cast<double>(std::ranges::count_if(row, [&](double x) { return order_of(x, value) == 0; }));
    ties += equal * equal - 1;
  }
  return ties;
}

}  // namespace

Concordance concordance_of(const std::vector<std::vector<double>>& scores) {
  const auto people = static_cast<double>(scores.size()), items = static_cast<double>(scores.front().size());
  std::vector<double> sums(scores.front().size(), 0);
  double ties = 0, squares = 0;
  for (const auto& row : scores) {
    const std::vector<double> ranks = ranks_of(row);
    for (std::size_t i = 0; i < ranks.size(); ++i) sums[i] += ranks[i];
    ties += ties_of(row);
  }
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

std::vector<double> ranks_of(std::span<const double> values) {
  std::vector<double> ranks;
  for (const double value : values) {
    const auto below =
        static_cast<double>(std::ranges::count_if(values, [&](double x) { return order_of(x, value) < 0; }));
    const auto ties =
        static_cast<double>(std::ranges::count_if(values, [&](double x) { return order_of(x, value) == 0; }));
    ranks.push_back(below + (ties + 1) / 2);
  }
  return ranks;
}

std::optional<double> spearman_rho(std::span<const double> a, std::span<const double> b) {
  const std::vector<double> ranks_a = ranks_of(a), ranks_b = ranks_of(b);
  const double mean = (static_cast<double>(a.size()) + 1) / 2;
  double both = 0, squares_a = 0, squares_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += (ranks_a[i] - mean) * (ranks_b[i] - mean);
    squares_a += (ranks_a[i] - mean) * (ranks_a[i] - mean);
    squares_b += (ranks_b[i] - mean) * (ranks_b[i] - mean);
  }
  if (squares_a == 0 || squares_b == 0) return std::nullopt;
  return both / std::sqrt(squares_a * squares_b);
}

std::optional<double> kendall_tau(std::span<const double> a, std::span<const double> b) {
  double both = 0, pairs_a = 0, pairs_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const int in_a = order_of(a[i], a[j]), in_b = order_of(b[i], b[j]);
      both += in_a * in_b, pairs_a += std::abs(in_a), pairs_b += std::abs(in_b);
    }
  if (pairs_a == 0 || pairs_b == 0) return std::nullopt;
  return both / std::sqrt(pairs_a * pairs_b);
}

}  // namespace tacto::analysis

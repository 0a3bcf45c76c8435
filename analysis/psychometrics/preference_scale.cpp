// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/preference_scale.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <functional>

#include "analysis/psychometrics/deviance.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

struct Wins {
  std::vector<std::string> names;
  Eigen::MatrixXd counts;  // row over column
};

Result<Wins> count_wins(std::span<const Preference> preferences) {
  Wins wins;
  for (const Preference& each : preferences) {
    if (each.winner == each.loser)
      return fail(ErrorKind::unsuitable, fmt::format("'{}' is compared with itself", each.winner));
    wins.names.push_back(each.winner);
    wins.names.push_back(each.loser);
  }
  std::ranges::sort(wins.names);
  wins.names.erase(std::ranges::unique(wins.names).begin(), wins.names.end());
  const auto count = static_cast<Eigen::Index>(wins.names.size());
  wins.counts = Eigen::MatrixXd::Zero(count, count);
  const auto place = [&](const std::string& name) {
    return std::ranges::lower_bound(wins.names, name) - wins.names.begin();
  };
  for (const Preference& each : preferences) wins.counts(place(each.winner), place(each.loser)) += each.count;
  return wins;
}

// The item and all that were preferred over it, directly or through others: no item outside was ever
// preferred over one of these.
std::vector<std::string> closed_above(const Wins& wins, Eigen::Index item) {
  std::vector<Eigen::Index> found = {item};
  for (std::size_t next = 0; next < found.size(); ++next)
    for (Eigen::Index other = 0; other < wins.counts.rows(); ++other)
      if (wins.counts(other, found[next]) > 0 && std::ranges::find(found, other) == found.end())
        found.push_back(other);
  std::ranges::sort(found);
  std::vector<std::string> names;
  for (const Eigen::Index each : found) names.push_back(wins.names[static_cast<std::size_t>(each)]);
  return names;
}

// Ford 1957: the maximum is finite if and only if, in each division of the items into two groups, an item of
// each group was preferred over one of the other.
Result<void> check_contradicted(const Wins& wins) {
  std::vector<std::string> smallest = wins.names;
  for (Eigen::Index item = 0; item < wins.counts.rows(); ++item)
    if (auto group = closed_above(wins, item); group.size() < smallest.size()) smallest = std::move(group);
  if (smallest.size() == wins.names.size()) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("no other item was ever preferred over {}: the scale has no bound",
                          fmt::join(smallest, ", ")),
              {}, "compare more often, or leave these items out");
}

double preferred(const Eigen::VectorXd& ability, Eigen::Index over, Eigen::Index under) {
  return 1 / (1 + std::exp(ability(under) - ability(over)));
}

// Newton's method on all abilities but that of `reference`, which stays 0. The likelihood is concave; a step
// is at most 1. Gives the covariance, with 0 in the reference's row.
Eigen::MatrixXd abilities_covariance(const Wins& wins, Eigen::Index reference, Eigen::VectorXd& ability) {
  const Eigen::Index count = wins.counts.rows();
  constexpr int kMostSteps = 200;
  constexpr double kConverged = 1e-12;
  Eigen::MatrixXd inverse;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
    Eigen::MatrixXd bend = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j) {
        const double p = preferred(ability, i, j), trials = wins.counts(i, j) + wins.counts(j, i);
        slope(i) += wins.counts(i, j) - trials * p;
        if (i == j) continue;
        bend(i, i) += trials * p * (1 - p);
        bend(i, j) -= trials * p * (1 - p);
      }
    bend.row(reference).setZero();
    bend.col(reference).setZero();
    bend(reference, reference) = 1;
    slope(reference) = 0;
    inverse = bend.ldlt().solve(Eigen::MatrixXd::Identity(count, count));
    const Eigen::VectorXd move = inverse * slope;
    const double largest = move.cwiseAbs().maxCoeff();
    ability += move / std::max(1.0, largest);
    if (largest < kConverged) break;
  }
  inverse(reference, reference) = 0;
  return inverse;
}

void judge_scale(PreferenceScale& scale, const Wins& wins, const Eigen::VectorXd& ability) {
  std::size_t pairs = 0;
  for (Eigen::Index i = 0; i < ability.size(); ++i)
    for (Eigen::Index j = 0; j < ability.size(); ++j) {
      const double won = wins.counts(i, j), trials = won + wins.counts(j, i);
      scale.comparisons += won;
      pairs += i < j && trials > 0;
      scale.deviance += deviance_part(won, trials, preferred(ability, i, j));
    }
  scale.freedom = pairs - std::min(pairs, wins.names.size() - 1);
  scale.p = chi_squared_p(scale.deviance, scale.freedom);
}

}  // namespace

Result<PreferenceScale> fit_preferences(std::span<const Preference> preferences) {
  const auto wins = count_wins(preferences);
  TACTO_TRY(wins);
  if (wins->names.size() < 2) return fail(ErrorKind::unsuitable, "there are fewer than two items to compare");
  TACTO_TRY(check_contradicted(*wins));
  Eigen::VectorXd ability = Eigen::VectorXd::Zero(wins->counts.rows());
  abilities_covariance(*wins, 0, ability);
  Eigen::Index reference = 0;
  ability.minCoeff(&reference);
  ability.array() -= ability(reference);
  const Eigen::MatrixXd covariance = abilities_covariance(*wins, reference, ability);
  const double z = boost::math::quantile(boost::math::normal(), 0.975);
  PreferenceScale scale;
  for (Eigen::Index i = 0; i < ability.size(); ++i) {
    const double reach = z * std::sqrt(covariance(i, i));
    scale.items.push_back(
        {wins->names[static_cast<std::size_t>(i)], {ability(i), ability(i) - reach, ability(i) + reach}});
  }
  std::ranges::stable_sort(scale.items, std::greater<>(),
                           [](const ScaledItem& item) { return item.ability.value; });
  judge_scale(scale, *wins, ability);
  return scale;
}

}  // namespace tacto::analysis

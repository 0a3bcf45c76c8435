// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/answers_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace tacto::analysis {
namespace {

using schema::Result;

Estimate steepness_of(const PsychometricFit& fit) {
  const auto [value, low, high] = fit.spread;
  const Shape shape = fit.function.shape;
  if (shape == Shape::weibull) return {1 / value, 1 / high, 1 / low};
  const double jnd = standard_quantile(shape, 0.75), width = 2 * standard_quantile(shape, 0.95);
  const double factor = fit.function.guess ? width : jnd;
  return {factor * value, factor * low, factor * high};
}

struct FittedGroups {
  std::vector<FittedGroup> groups;
  std::vector<std::string> not_fitted;
};

Result<FittedGroups> fit_groups(const AnswersTable& table, const PsychometricOptions& options,
                                const std::function<void(double)>& tell) {
  FittedGroups fitted;
  double done = 0;
  for (const auto& group : table.groups) {
    auto fit = fit_psychometric(group.rows, options);
    tell(++done / static_cast<double>(table.groups.size()));
    if (fit) {
      const Estimate steepness = steepness_of(*fit);
      fitted.groups.push_back({group.by, std::move(*fit), steepness});
      continue;
    }
    if (!group.by.empty()) fit.error().where = group_name(group.by);
    fitted.not_fitted.push_back(fmt::format("{}: {}", group_name(group.by), fit.error().what));
    if (!table.of_study || fitted.not_fitted.size() == table.groups.size()) return schema::forward_error(fit);
  }
  return fitted;
}

OverPeople over_people(const std::vector<FittedGroup>& groups) {
  OverPeople all;
  for (const FittedGroup& group : groups) {
    const std::vector<std::string> condition(group.by.begin() + 1, group.by.end());
    auto found = std::ranges::find(all.conditions, condition, &ConditionOverPeople::condition);
    if (found == all.conditions.end()) found = all.conditions.insert(found, {condition, {}, {}, 0, {}});
    found->people.push_back(group.by.front());
    found->figures.push_back(group.steepness.value);
  }
  for (ConditionOverPeople& each : all.conditions) {
    each.mean = std::accumulate(each.figures.begin(), each.figures.end(), 0.0) /
                static_cast<double>(each.figures.size());
    each.geometric = geometric_mean(each.figures);
  }
  return all;
}

// The figures of the other condition's people in this condition's order; empty if the people differ.
std::vector<double> matched(const ConditionOverPeople& one, const ConditionOverPeople& other) {
  std::vector<double> figures;
  for (const std::string& person : one.people) {
    const auto found = std::ranges::find(other.people, person);
    if (found == other.people.end() || one.people.size() != other.people.size()) return {};
    figures.push_back(other.figures[static_cast<std::size_t>(found - other.people.begin())]);
  }
  return figures;
}

OverPeople compared_people(const std::vector<FittedGroup>& groups) {
  OverPeople all = over_people(groups);
  if (all.conditions.size() != 2) return all;
  const auto& first = all.conditions.front();
  if (const auto second = matched(first, all.conditions.back()); second.size() > 1)
    all.test = paired_log_test(first.figures, second);
  return all;
}

}  // namespace

std::string group_name(const std::vector<std::string>& by) {
  return by.empty() ? "all" : fmt::format("{}", fmt::join(by, ", "));
}

Result<AnswersFit> fit_answers(AnswersTable table, PsychometricOptions options,
                               const std::function<void(double)>& tell) {
  options.threshold = table.pse;
  auto fitted = fit_groups(table, options, tell);
  TACTO_TRY(fitted);
  AnswersFit all{std::move(table),
                 options,
                 options.guess ? "threshold" : "PSE",
                 "exponent",
                 "",
                 std::move(fitted->groups),
                 std::move(fitted->not_fitted),
                 {},
                 {}};
  if (options.shape != Shape::weibull) {
    all.steepness_name = options.guess ? "width" : "JND";
    all.steepness_unit = all.table.unit;
  }
  if (all.groups.size() < 2) return all;
  all.over_people = compared_people(all.groups);
  if (options.lapse) return all;
  PsychometricOptions without = options;
  without.lapse = 0;
  if (const auto others = fit_groups(all.table, without, [](double) {}); others && others->not_fitted.empty())
    all.without_lapses = compared_people(others->groups);
  return all;
}

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/answers_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace tacto::analysis {
namespace {

using schema::Result;

Estimate scaled(const Estimate& estimate, double factor) {
  return {estimate.value * factor, estimate.low * factor, estimate.high * factor};
}

Result<std::vector<FittedGroup>> fit_groups(const AnswersTable& table, const PsychometricOptions& options,
                                            const std::function<void(double)>& tell) {
  std::vector<FittedGroup> groups;
  for (const auto& group : table.groups) {
    auto fit = fit_psychometric(group.rows, options);
    if (!fit && !group.by.empty()) fit.error().where = group_name(group.by);
    TACTO_TRY(fit);
    groups.push_back({group.by, std::move(*fit)});
    tell(static_cast<double>(groups.size()) / static_cast<double>(table.groups.size()));
  }
  return groups;
}

OverPeople over_people(const std::vector<FittedGroup>& groups, const Steepness& steepness) {
  OverPeople all;
  for (const FittedGroup& group : groups) {
    const std::vector<std::string> condition(group.by.begin() + 1, group.by.end());
    auto found = std::ranges::find(all.conditions, condition, &ConditionOverPeople::condition);
    if (found == all.conditions.end()) found = all.conditions.insert(found, {condition, {}, {}, 0, {}});
    found->people.push_back(group.by.front());
    found->figures.push_back(steepness.of(group.fit).value);
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

OverPeople compared_people(const std::vector<FittedGroup>& groups, const Steepness& steepness) {
  OverPeople all = over_people(groups, steepness);
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

Steepness steepness_of(const PsychometricOptions& options) {
  if (options.shape == Shape::weibull) return {"exponent", false};
  return {options.guess ? "width" : "JND", true};
}

Estimate Steepness::of(const PsychometricFit& fit) const {
  const PsychometricFunction& f = fit.function;
  if (!in_levels) return {1 / fit.spread.value, 1 / fit.spread.high, 1 / fit.spread.low};
  if (!f.guess) return scaled(fit.spread, standard_quantile(f.shape, 0.75));
  return scaled(fit.spread, standard_quantile(f.shape, 0.95) - standard_quantile(f.shape, 0.05));
}

Result<AnswersFit> fit_answers(const AnswersTable& table, const PsychometricOptions& options,
                               const std::function<void(double)>& tell) {
  AnswersFit all{table.columns, table.level_name, table.unit, options, {}, {}, {}};
  auto groups = fit_groups(table, options, tell);
  TACTO_TRY(groups);
  all.groups = std::move(*groups);
  if (all.groups.size() < 2) return all;
  const Steepness steepness = steepness_of(options);
  all.over_people = compared_people(all.groups, steepness);
  if (options.lapse) return all;
  PsychometricOptions without = options;
  without.lapse = 0;
  if (const auto others = fit_groups(table, without, [](double) {}))
    all.without_lapses = compared_people(*others, steepness);
  return all;
}

}  // namespace tacto::analysis

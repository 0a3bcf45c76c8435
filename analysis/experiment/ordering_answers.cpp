// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/ordering_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/experiment/study_answers.hpp"

namespace tacto::analysis {
namespace {

using Scores = std::vector<std::vector<double>>;

// The place of each standard in one answer, from 1.
std::vector<double> places_of(const Run& run, const Attempt& attempt) {
  const std::vector<std::string>& standards = run.study.protocol.standards;
  std::vector<double> places(standards.size());
  double place = 0;
  for (const std::string& code : codes_in(attempt.answered->word)) {
    const std::string& name = stimulus_of(run.study.key, code).name;
    places[static_cast<std::size_t>(std::ranges::find(standards, name) - standards.begin())] = ++place;
  }
  return places;
}

// Of the mean of the rows.
OrderedBy ordered_by(std::string participant, const Scores& rows, const std::vector<double>& intended) {
  OrderedBy ordered{std::move(participant), rows.size(), std::vector<double>(rows.front().size(), 0), {}, {}};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      ordered.mean_ranks[i] += row[i];  // whole numbers first, so that equal sums are ties
  for (double& rank : ordered.mean_ranks) rank /= static_cast<double>(rows.size());
  if (rows.size() > 1) ordered.agreement = concordance_of(rows);
  if (intended.empty()) return ordered;
  const auto rho = spearman_rho(intended, ordered.mean_ranks);
  const auto tau = kendall_tau(intended, ordered.mean_ranks);
  if (rho && tau) ordered.intended = RankCorrelation{*rho, *tau};
  return ordered;
}

std::string order_in_words(const OrderingAnswers& all, const OrderedBy& by) {
  std::vector<std::size_t> order(all.standards.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return by.mean_ranks[i]; });
  std::vector<std::string> words;
  for (const std::size_t i : order)
    words.push_back(fmt::format("{} {:.3g}", all.standards[i], by.mean_ranks[i]));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string agreement_in_words(const OrderedBy& by) {
  return by.agreement ? fmt::format("{:.3f}", by.agreement->w) : "unknown: one order";
}

std::string correlation_in_words(const OrderedBy& by) {
  if (!by.intended) return "unknown";
  return fmt::format("Spearman's rho {:.3f}, Kendall's tau {:.3f}", by.intended->rho, by.intended->tau);
}

schema::ResultPicture picture_of(const OrderingAnswers& all) {
  schema::ResultPicture picture{"Mean rank of each person, and of all",
                                "mean rank (1: the least)",
                                all.intended.empty() ? "number of the texture" : "intended parameter",
                                false,
                                {}};
  const auto add = [&](const std::string& name, const OrderedBy& by) {
    schema::ResultCurve& curve = picture.curves.emplace_back(schema::ResultCurve{name, {}, {}, false, true});
    for (std::size_t i = 0; i < all.standards.size(); ++i) {
      curve.x.push_back(by.mean_ranks[i]);
      curve.y.push_back(all.intended.empty() ? static_cast<double>(i + 1) : all.intended[i]);
    }
  };
  for (const OrderedBy& each : all.people) add(each.participant, each);
  if (all.people.size() > 1) add("all", all.all);
  return picture;
}

}  // namespace

OrderingAnswers ordering_answers(const std::vector<Run>& runs) {
  OrderingAnswers all;
  all.standards = runs.front().study.protocol.standards;
  all.intended = runs.front().study.protocol.intended;
  std::vector<std::string> simulated;
  Scores means;
  for (const Run& run : runs) {
    add_simulated(simulated, run);
    all.abandoned += run.queue.abandoned();
    Scores rows;
    for (const Attempt& attempt : run.queue.attempts())
      if (attempt.counts()) rows.push_back(places_of(run, attempt));
    all.people.push_back(ordered_by(run.journal.plan.participant, rows, all.intended));
    means.push_back(all.people.back().mean_ranks);
  }
  all.all = ordered_by({}, means, all.intended);
  all.simulated = fmt::format("{}", fmt::join(simulated, "; "));
  return all;
}

Findings findings_of(const OrderingAnswers& all) {
  Findings findings;
  const bool one = all.people.size() == 1;
  const OrderedBy& by = one ? all.people.front() : all.all;
  std::string verdict = "from least to most: " + order_in_words(all, by);
  if (by.agreement)
    verdict += fmt::format("; Kendall's W {:.3f} ({})", by.agreement->w,
                           one ? "between the orders of one person" : "between people");
  findings.figures.push_back({"verdict", verdict});
  findings.figures.push_back({"mean ranks", order_in_words(all, by)});
  if (by.agreement)
    findings.figures.push_back(
        {"Kendall's W",
         fmt::format("{:.3f}; chi-squared {:.3f} with {} degrees of freedom, p {:.2g}, if the "
                     "orders were random",
                     by.agreement->w, by.agreement->chi_squared, by.agreement->freedom, by.agreement->p)});
  if (!all.intended.empty()) findings.figures.push_back({"intended parameter", correlation_in_words(by)});
  if (all.abandoned > 0)
    findings.figures.push_back(
        {"abandoned",
         fmt::format("{} trials, after too many attempts that were not delivered", all.abandoned)});
  findings.groups = {{"participant", "orders", "mean ranks", "W of their orders", "intended parameter"}};
  for (const OrderedBy& each : all.people)
    findings.groups.push_back({each.participant, fmt::format("{}", each.orders), order_in_words(all, each),
                               agreement_in_words(each), correlation_in_words(each)});
  findings.pictures.push_back(picture_of(all));
  findings.simulated = all.simulated;
  return findings;
}

}  // namespace tacto::analysis

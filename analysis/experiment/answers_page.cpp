// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/answers_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"

namespace tacto::analysis {
namespace {

using schema::ResultCurve;
using schema::ResultFigure;
using schema::ResultPicture;

constexpr double kUsualP = 0.05;
constexpr const char *kMisfit = "the answers scatter more than the model permits",
                     *kNoMisfit = "no misfit found";

std::string with_unit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + " " + unit;
}

std::string fit_in_words(double deviance, std::size_t freedom, double p) {
  if (freedom == 0) return "too few levels to test it";
  return fmt::format("deviance {:.4g} with {} degrees of freedom, p {:.2g}: {}", deviance, freedom, p,
                     p < kUsualP ? kMisfit : kNoMisfit);
}

std::string in_words(const Estimate& estimate, const std::string& unit) {
  return with_unit(fmt::format("{:.4g} [{:.4g}, {:.4g}]", estimate.value, estimate.low, estimate.high), unit);
}

std::string share(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

std::string lapse_in_words(const AnswersFit& all, const PsychometricFit& fit) {
  if (all.options.lapse) return "fixed at " + share(*all.options.lapse);
  return fmt::format("{} (below {} with 95 %)", share(fit.function.lapse), share(fit.lapse_high));
}

std::string shape_in_words(Shape shape) {
  if (shape == Shape::weibull) return "Weibull function";
  return shape == Shape::normal ? "cumulative normal function" : "logistic function";
}

std::string threshold_in_words(const AnswersFit& all, const PsychometricFit& fit) {
  if (all.options.threshold) return fmt::format("fixed at {:g}", *all.options.threshold);
  return in_words(fit.threshold, all.table.unit);
}

std::string assumed(const AnswersFit& all) {
  const PsychometricOptions& o = all.options;
  std::string text = shape_in_words(o.shape);
  text += o.guess ? fmt::format("; right by guessing {}", share(*o.guess))
                  : "; two stimuli are compared: lapses at both ends alike";
  if (o.threshold)
    text += fmt::format(
        "; the PSE is {:g}, because levels of one sign cannot separate a bias of the answers from the JND",
        *o.threshold);
  if (!o.lapse) text += "; prior of the lapse Beta(1, 19)";
  text += o.overdispersed ? "; answers beta-binomial, prior of the overdispersion Beta(1, 10)"
                          : "; answers independent";
  return text + (o.threshold ? "; intervals: 95 % of the posterior, flat in width within the range of the "
                               "levels, to both sides of the PSE"
                             : "; intervals: 95 % of the posterior, flat in threshold and width within the "
                               "range of the levels");
}

std::string answers_in_words(const AnswersFit& all) {
  double yes = 0, trials = 0;
  for (const FittedGroup& group : all.groups)
    for (const LevelCount& each : group.fit.levels) {
      yes += each.yes;
      trials += each.trials;
    }
  return fmt::format("{:g} '{}' in {:g} trials, against '{}'", yes, all.table.columns.yes, trials,
                     all.table.columns.level);
}

std::string p_in_words(const PairedTest& test) {
  return fmt::format("paired t {:.3g} ({:g} degrees of freedom, logarithms), p {:.2g}", test.t, test.freedom,
                     test.p);
}

// "2.926 and 3.619 cm/s"
std::string means_in_words(const AnswersFit& all, const OverPeople& over) {
  std::vector<std::string> means;
  for (const ConditionOverPeople& each : over.conditions) means.push_back(fmt::format("{:.4g}", each.mean));
  return with_unit(fmt::format("{}", fmt::join(means, " and ")), all.steepness_unit);
}

std::string compared(const AnswersFit& all, const OverPeople& over) {
  std::string text = fmt::format("mean {} {}", all.steepness_name, means_in_words(all, over));
  if (over.test) text += "; " + p_in_words(*over.test);
  return text;
}

// "vibration_hz 32"
std::string condition_in_words(const AnswersFit& all, const std::vector<std::string>& condition) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < condition.size(); ++i)
    words.push_back(fmt::format("{} {}", all.table.columns.by[i + 1], condition[i]));
  return fmt::format("{}", fmt::join(words, ", "));
}

void add_people(std::vector<ResultFigure>& figures, const AnswersFit& all) {
  for (const ConditionOverPeople& each : all.over_people->conditions) {
    const std::string condition = condition_in_words(all, each.condition);
    figures.push_back(
        {condition.empty() ? all.steepness_name : fmt::format("{} at {}", all.steepness_name, condition),
         fmt::format("mean {:.4g} of {} people; geometric mean {}", each.mean, each.people.size(),
                     in_words(each.geometric, all.steepness_unit))});
  }
  if (all.over_people->test) figures.push_back({"difference", p_in_words(*all.over_people->test)});
  if (all.without_lapses) figures.push_back({"with lapses fixed at 0", compared(all, *all.without_lapses)});
}

// Each note once, with the groups that it is about.
std::vector<std::string> all_notes(const AnswersFit& all) {
  std::vector<std::pair<std::string, std::vector<std::string>>> notes;
  for (const FittedGroup& group : all.groups)
    for (const std::string& note : group.fit.notes) {
      auto found = std::ranges::find(notes, note, [](const auto& each) { return each.first; });
      if (found == notes.end()) found = notes.insert(found, {note, {}});
      found->second.push_back(group_name(group.by));
    }
  std::vector<std::string> words;
  for (const auto& [note, groups] : notes)
    words.push_back(all.groups.size() == 1 ? note : fmt::format("{} ({})", note, fmt::join(groups, "; ")));
  return words;
}

void add_one(std::vector<ResultFigure>& figures, const AnswersFit& all) {
  const FittedGroup& group = all.groups.front();
  const PsychometricFit& fit = group.fit;
  figures.push_back({all.threshold_name, threshold_in_words(all, fit)});
  figures.push_back({all.steepness_name, in_words(group.steepness, all.steepness_unit)});
  figures.push_back({"lapses", lapse_in_words(all, fit)});
  if (all.options.overdispersed)
    figures.push_back({"overdispersion", fmt::format("{:.3g} (below {:.3g} with 95 %)", fit.overdispersion,
                                                     fit.overdispersion_high)});
  figures.push_back({"fit", fit_in_words(fit.deviance, fit.freedom, fit.p)});
}

// The group with the smallest p. With several groups p is judged as the smallest of so many.
const FittedGroup& worst_fit(const AnswersFit& all) {
  return *std::ranges::min_element(all.groups, {}, [](const FittedGroup& group) { return group.fit.p; });
}

// Whether the answers of all levels, of all groups together, are at least as often 'yes' as by guessing
// between two alternatives, with a margin for chance.
bool could_be_guessing_of_two(const AnswersFit& all) {
  constexpr double kLeast = 0.4;
  std::map<double, LevelCount> levels;
  for (const FittedGroup& group : all.groups)
    for (const LevelCount& each : group.fit.levels) {
      levels[each.level].yes += each.yes;
      levels[each.level].trials += each.trials;
    }
  return !all.options.guess && !all.options.threshold && std::ranges::all_of(levels, [](const auto& each) {
    return each.second.yes >= kLeast * each.second.trials;
  });
}

bool misfit(const AnswersFit& all) {
  return worst_fit(all).fit.p * static_cast<double>(all.groups.size()) < kUsualP;
}

std::string fits_in_words(const AnswersFit& all) {
  const FittedGroup& worst = worst_fit(all);
  return fmt::format("smallest p of the deviance {:.2g} ({}), of {} groups: {}", worst.fit.p,
                     group_name(worst.by), all.groups.size(), misfit(all) ? kMisfit : kNoMisfit);
}

// Marks of the proportions, then the function over the same levels.
void add_group(ResultPicture& picture, const std::string& name, const FittedGroup& group) {
  ResultCurve marks{name, {}, {}, false, true}, curve{"", {}, {}};
  for (const LevelCount& each : group.fit.levels) {
    marks.x.push_back(each.level);
    marks.y.push_back(each.yes / each.trials);
  }
  constexpr int kPoints = 200;
  const double low = marks.x.front(), step = (marks.x.back() - low) / kPoints;
  for (int i = 0; i <= kPoints; ++i) {
    curve.x.push_back(low + step * i);
    curve.y.push_back(group.fit.function(curve.x.back()));
  }
  picture.curves.push_back(std::move(marks));
  picture.curves.push_back(std::move(curve));
}

std::vector<std::vector<std::string>> groups_table(const AnswersFit& all) {
  std::vector<std::vector<std::string>> rows = {all.table.columns.by};
  for (const std::string& name :
       {all.threshold_name, all.steepness_name, std::string("lapses"), std::string("p of the deviance")})
    rows.front().push_back(name);
  for (const FittedGroup& group : all.groups) {
    auto& row = rows.emplace_back(group.by);
    row.push_back(threshold_in_words(all, group.fit));
    row.push_back(in_words(group.steepness, all.steepness_unit));
    row.push_back(lapse_in_words(all, group.fit));
    row.push_back(fmt::format("{:.2g}", group.fit.p));
  }
  return rows;
}

std::string answers_verdict(const AnswersFit& all) {
  if (all.over_people && all.over_people->test)
    return fmt::format("{}: {}",
                       all.over_people->test->p < kUsualP ? "the conditions differ" : "no difference found",
                       compared(all, *all.over_people));
  if (all.over_people) return compared(all, *all.over_people);
  const FittedGroup& group = all.groups.front();
  const PsychometricFit& fit = group.fit;
  return fmt::format(
      "{} {}, {} {}", all.threshold_name,
      all.options.threshold ? threshold_in_words(all, fit)
                            : with_unit(fmt::format("{:.4g}", fit.threshold.value), all.table.unit),
      all.steepness_name, with_unit(fmt::format("{:.4g}", group.steepness.value), all.steepness_unit));
}

std::vector<ResultFigure> answers_figures(const AnswersFit& all) {
  std::string verdict = answers_verdict(all);
  if (!all.not_fitted.empty()) verdict += fmt::format("; {} not fitted", all.not_fitted.size());
  std::vector<ResultFigure> figures = {{"verdict", std::move(verdict)}};
  if (all.groups.size() == 1)
    add_one(figures, all);
  else
    add_people(figures, all);
  if (all.groups.size() > 1) figures.push_back({"fit", fits_in_words(all)});
  figures.push_back({"answers", answers_in_words(all)});
  figures.push_back({"assumed", assumed(all)});
  if (could_be_guessing_of_two(all))
    figures.push_back(
        {"note",
         "at no level is less than about half of the answers yes: if an answer is right or wrong, of two "
         "alternatives, give --guess 50%"});
  else if (misfit(all) && !all.options.overdispersed)
    figures.push_back({"note", "--overdispersed widens the intervals for answers that scatter so"});
  for (const std::string& note : all_notes(all)) figures.push_back({"note", note});
  for (const std::string& each : all.table.reversals) figures.push_back({"reversals", each});
  for (const std::string& each : all.not_fitted) figures.push_back({"not fitted", each});
  return figures;
}

std::vector<ResultPicture> answers_pictures(const AnswersFit& all) {
  std::vector<ResultPicture> pictures;
  for (const FittedGroup& group : all.groups) {
    const std::string title = group.by.empty() ? "Answers and fitted function" : group.by.front();
    auto found = std::ranges::find(pictures, title, &ResultPicture::title);
    if (found == pictures.end()) {
      const std::string unit = all.table.unit.empty() ? "" : " (" + all.table.unit + ")";
      found = pictures.insert(found, {title,
                                      all.table.level_name + unit,
                                      fmt::format("proportion of '{}'", all.table.columns.yes),
                                      false,
                                      {}});
    }
    // The person is in the title.
    const std::vector<std::string> condition(group.by.begin() + (group.by.empty() ? 0 : 1), group.by.end());
    add_group(*found, condition_in_words(all, condition), group);
  }
  return pictures;
}

std::string preferences_verdict(const std::vector<ScaledGroup>& scales) {
  std::vector<std::string> verdicts;
  for (const ScaledGroup& each : scales) {
    const ScaledItem &most = each.scale.items.front(), &least = each.scale.items.back();
    std::string verdict =
        fmt::format("{} is preferred most, {:.4g} over {}", most.name, most.ability.value, least.name);
    verdicts.push_back(each.by.empty() ? verdict : group_name(each.by) + ": " + verdict);
  }
  return fmt::format("{}", fmt::join(verdicts, "; "));
}

std::vector<ResultFigure> preferences_figures(const std::vector<ScaledGroup>& scales) {
  std::vector<ResultFigure> figures = {{"verdict", preferences_verdict(scales)}};
  for (const ScaledGroup& each : scales) {
    const std::string group = each.by.empty() ? "" : group_name(each.by) + " ";
    for (const ScaledItem& item : each.scale.items)
      figures.push_back({group + item.name, &item == &each.scale.items.back()
                                                ? std::string("0 (the reference)")
                                                : in_words(item.ability, "")});
    figures.push_back({group + "fit", fit_in_words(each.scale.deviance, each.scale.freedom, each.scale.p)});
    figures.push_back({group + "comparisons", fmt::format("{:g}", each.scale.comparisons)});
  }
  figures.push_back(
      {"assumed",
       "Bradley-Terry: the chance that A is preferred over B is 1 / (1 + exp(B - A)); abilities are natural "
       "logarithms of odds; comparisons are independent; intervals: 95 %, of the difference to the "
       "reference"});
  return figures;
}

std::vector<ResultPicture> preferences_pictures(const std::vector<ScaledGroup>& scales) {
  std::vector<ResultPicture> pictures;
  for (const ScaledGroup& each : scales) {
    ResultPicture& picture = pictures.emplace_back(
        ResultPicture{each.by.empty() ? "Abilities with 95 % intervals" : group_name(each.by),
                      "ability (logarithm of odds)",
                      "rank; the last is the reference",
                      false,
                      {}});
    for (std::size_t i = 0; i < each.scale.items.size(); ++i) {
      const auto& [name, ability] = each.scale.items[i];
      const auto rank = static_cast<double>(i + 1);
      picture.curves.push_back({name, {ability.value}, {rank}, false, true});
      picture.curves.push_back({"", {ability.low, ability.high}, {rank, rank}});
    }
  }
  return pictures;
}

}  // namespace

Findings findings_of(const AnswersFit& all) {
  return {answers_figures(all), answers_pictures(all), groups_table(all), all.table.simulated};
}

Findings findings_of(const std::vector<ScaledGroup>& scales) {
  return {preferences_figures(scales), preferences_pictures(scales), {}, {}};
}

schema::Result<std::string> findings_page(const std::string& file, const Findings& findings) {
  const auto drawn = pictures_html(findings.pictures, findings.simulated);
  TACTO_TRY(drawn);
  const std::string name = std::filesystem::path(file).filename().string();
  std::string body = fmt::format("<h1>Experiment: {}</h1>\n", escaped(name)) + answer(findings.verdict()) +
                     simulated_box(findings.simulated) + figures_html(findings.figures, {"verdict"}) + *drawn;
  if (!findings.groups.empty()) body += html_table(findings.groups);
  return html_document(fmt::format("{}: {}", name, findings.verdict()), body);
}

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/amplitude_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/experiment/study_answers.hpp"
#include "analysis/psychometrics/over_people.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {
namespace {

MatchedPerson matched_person(const Run& run) {
  MatchedPerson person;
  person.participant = run.journal.plan.participant;
  double sum_at_0 = 0;
  for (const Attempt& attempt : run.queue.attempts()) {
    if (!attempt.counts()) continue;
    const RatedRatio rated{attempt.trial.ratio, rating_of(attempt)};
    person.ratings.push_back(rated);
    if (rated.rating != 0) continue;
    ++person.rated_0;
    sum_at_0 += rated.ratio;
  }
  if (person.rated_0 > 0) person.mean_at_0 = sum_at_0 / static_cast<double>(person.rated_0);
  if (const auto match = match_of_ratings(person.ratings))
    person.match = *match;
  else
    person.why = schema::message(match.error());
  return person;
}

std::string match_in_words(const std::optional<Estimate>& match) {
  if (!match) return "unknown";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", match->value, match->low, match->high);
}

std::string mean_in_words(const std::optional<double>& mean) {
  return mean ? fmt::format("{:.3f}", *mean) : "unknown: nothing was rated 0";
}

schema::ResultPicture picture_of(const MatchedPerson& person) {
  schema::ResultCurve marks{"rating", {}, {}, false, true};
  for (const RatedRatio& each : person.ratings) {
    marks.x.push_back(each.ratio);
    marks.y.push_back(each.rating);
  }
  return {person.participant, "ratio to the real sample", "rating", false, {std::move(marks)}};
}

}  // namespace

AmplitudeAnswers amplitude_answers(const std::vector<Run>& runs) {
  AmplitudeAnswers all;
  std::vector<std::string> simulated;
  std::vector<double> matches;
  double means = 0;
  std::size_t with_mean = 0;
  for (const Run& run : runs) {
    add_simulated(simulated, run);
    const MatchedPerson& person = all.people.emplace_back(matched_person(run));
    if (person.match) matches.push_back(person.match->value);
    if (!person.mean_at_0) continue;
    means += *person.mean_at_0;
    ++with_mean;
  }
  if (with_mean > 0) all.mean_at_0 = means / static_cast<double>(with_mean);
  if (all.people.size() == 1)
    all.match = all.people.front().match;
  else if (matches.size() > 1)
    all.match = geometric_mean(matches);
  all.simulated = fmt::format("{}", fmt::join(simulated, "; "));
  return all;
}

Findings findings_of(const AmplitudeAnswers& all) {
  Findings findings;
  const std::string match = match_in_words(all.match), mean = mean_in_words(all.mean_at_0);
  const bool one = all.people.size() == 1;
  findings.figures.push_back({"verdict", "match at the ratio " + match});
  findings.figures.push_back(
      {"match, fitted",
       match + (one ? " (95 % interval of one person)" : " (geometric mean of the people, 95 % interval)")});
  findings.figures.push_back({"mean ratio at rating 0", mean + (one ? "" : " (mean over people)")});
  for (const MatchedPerson& each : all.people)
    if (!each.why.empty()) findings.figures.push_back({"note", each.participant + ": " + each.why});
  findings.groups = {{"participant", "trials", "rated 0", "mean ratio at rating 0", "match"}};
  for (const MatchedPerson& each : all.people) {
    findings.groups.push_back({each.participant, fmt::format("{}", each.ratings.size()),
                               fmt::format("{}", each.rated_0), mean_in_words(each.mean_at_0),
                               match_in_words(each.match)});
    findings.pictures.push_back(picture_of(each));
  }
  findings.simulated = all.simulated;
  return findings;
}

}  // namespace tacto::analysis

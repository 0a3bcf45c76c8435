// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/fidelity_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "analysis/experiment/study_answers.hpp"
#include "analysis/psychometrics/over_people.hpp"

namespace tacto::analysis {
namespace {

std::size_t number_of(const Run& run, const std::string& code) {
  const auto& names = run.study.protocol.standards;
  return static_cast<std::size_t>(std::ranges::find(names, stimulus_of(run.study.key, code).name) -
                                  names.begin());
}

void add(SameAnswers& sum, const SameAnswers& other) {
  sum.same_of_own += other.same_of_own, sum.own += other.own;
  sum.same_of_other += other.same_of_other, sum.other += other.other;
}

SameAnswers answer_of(const Attempt& attempt) {
  const double same = attempt.answered->choice == schema::kSameChoice ? 1 : 0;
  return attempt.trial.code == attempt.trial.sample ? SameAnswers{same, 1, 0, 0} : SameAnswers{0, 0, same, 1};
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  return (values[values.size() / 2] + values[(values.size() - 1) / 2]) / 2;
}

std::optional<Estimate> over_people(const std::vector<FidelityPerson>& people) {
  if (people.size() == 1) return people.front().d_prime;
  double sum = 0, squares = 0, count = 0;
  for (const FidelityPerson& each : people)
    if (each.d_prime) sum += each.d_prime->value, ++count;
  if (count < 2) return std::nullopt;
  const double mean = sum / count;
  for (const FidelityPerson& each : people)
    if (each.d_prime) squares += std::pow(each.d_prime->value - mean, 2);
  const double reach = student_reach(count - 1) * std::sqrt(squares / (count - 1) / count);
  return Estimate{mean, mean - reach, mean + reach};
}

std::string share_in_words(double same, double trials) {
  if (trials == 0) return "none";
  return fmt::format("{:.1f} % ({:g} of {:g})", 100 * same / trials, same, trials);
}

std::string d_prime_in_words(const std::optional<Estimate>& d_prime) {
  if (!d_prime) return "unknown";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", d_prime->value, d_prime->low, d_prime->high);
}

// "E was called the same as E 9 of 10, as C 2 of 5"
std::string pairs_in_words(const FidelityAnswers& all, std::size_t played) {
  std::vector<std::string> words;
  for (std::size_t sample = 0; sample < all.standards.size(); ++sample) {
    const SameAnswers& pair = all.pairs[played][sample];
    words.push_back(fmt::format("{} {:g} of {:g}", all.standards[sample],
                                pair.same_of_own + pair.same_of_other, pair.own + pair.other));
  }
  return fmt::format("called the same as {}", fmt::join(words, ", "));
}

}  // namespace

FidelityAnswers fidelity_answers(const std::vector<Run>& runs) {
  FidelityAnswers all;
  all.standards = runs.front().study.protocol.standards;
  all.pairs.assign(all.standards.size(), std::vector<SameAnswers>(all.standards.size()));
  std::vector<std::string> simulated;
  std::vector<double> errors_db;
  for (const Run& run : runs) {
    add_simulated(simulated, run);
    all.abandoned += run.queue.abandoned();
    FidelityPerson& person = all.people.emplace_back();
    person.participant = run.journal.plan.participant;
    for (const Attempt& attempt : run.queue.attempts()) {
      if (!attempt.counts()) continue;
      const SameAnswers answer = answer_of(attempt);
      add(person.answers, answer);
      add(all.pairs[number_of(run, attempt.trial.code)][number_of(run, attempt.trial.sample)], answer);
      for (const schema::IntervalFacts& facts : attempt.judged->intervals)
        if (facts.predicted_error_db) errors_db.push_back(*facts.predicted_error_db);
    }
    person.d_prime = d_prime_of_same(person.answers);
  }
  all.d_prime = over_people(all.people);
  all.predicted_error_db = median(std::move(errors_db));
  all.simulated = fmt::format("{}", fmt::join(simulated, "; "));
  return all;
}

SameAnswers sum_of(const FidelityAnswers& all) {
  SameAnswers sum;
  for (const FidelityPerson& each : all.people) add(sum, each.answers);
  return sum;
}

Findings findings_of(const FidelityAnswers& all) {
  Findings findings;
  const SameAnswers sum = sum_of(all);
  const std::string own = share_in_words(sum.same_of_own, sum.own),
                    other = share_in_words(sum.same_of_other, sum.other);
  findings.figures.push_back(
      {"verdict",
       fmt::format("played textures were called the same as their own sample in {}, as another one in "
                   "{}: d' {}",
                   own, other, d_prime_in_words(all.d_prime))});
  findings.figures.push_back({"same, beside its own sample", own});
  findings.figures.push_back({"same, beside another sample", other});
  findings.figures.push_back({"d'", d_prime_in_words(all.d_prime) +
                                        (all.people.size() == 1 ? " (one person, 95 % interval)"
                                                                : " (mean over people, 95 % interval)")});
  for (std::size_t i = 0; i < all.standards.size(); ++i)
    findings.figures.push_back({all.standards[i] + " played", pairs_in_words(all, i)});
  if (all.predicted_error_db)
    findings.figures.push_back(
        {"predicted error",
         fmt::format("{:.1f} dB, the median of what was delivered, by the transducer's model; "
                     "'fidelity' computes it by bands",
                     *all.predicted_error_db)});
  findings.figures.push_back({"assumed",
                              "same or different as a yes-no decision with normal distributions of equal "
                              "variance; shares (n + 1/2) / "
                              "(N + 1), so that d' is finite"});
  if (all.abandoned > 0)
    findings.figures.push_back(
        {"abandoned",
         fmt::format("{} trials, after too many attempts that were not delivered", all.abandoned)});
  findings.groups = {{"participant", "same, own sample", "same, other samples", "d'"}};
  for (const FidelityPerson& each : all.people)
    findings.groups.push_back({each.participant, share_in_words(each.answers.same_of_own, each.answers.own),
                               share_in_words(each.answers.same_of_other, each.answers.other),
                               d_prime_in_words(each.d_prime)});
  findings.simulated = all.simulated;
  return findings;
}

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/study_power.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "analysis/experiment/study_answers.hpp"
#include "analysis/psychometrics/over_people.hpp"
#include "analysis/psychometrics/psychometric_fit.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

// Draws that are the same on any machine (std's distributions are not).
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  double uniform() { return (static_cast<double>(random_() >> 12U) + 0.5) * 0x1p-52; }
  double normal() { return standard_quantile(Shape::normal, uniform()); }

 private:
  std::mt19937_64 random_;
};

// The answers of a person with this Weber fraction, who answers by chance in a share of the trials.
std::vector<LevelCount> answers_of(const schema::Protocol& protocol, double weber, double lapse,
                                   Draws& draws) {
  const PsychometricFunction truth{
      Shape::normal, 0, weber / standard_quantile(Shape::normal, 0.75), lapse / 2, {}};
  std::vector<LevelCount> levels;
  for (const double stretch : protocol.levels) {
    LevelCount& level =
        levels.emplace_back(LevelCount{stretch, 0, static_cast<double>(protocol.repetitions)});
    for (int i = 0; i < protocol.repetitions; ++i) level.yes += draws.uniform() < truth(stretch) ? 1 : 0;
  }
  return levels;
}

// ln of the fitted JND.
std::optional<double> log_of_fit(std::vector<LevelCount> answers, const PsychometricOptions& options) {
  const auto fit = most_probable_function(std::move(answers), options);
  if (!fit) return std::nullopt;
  return std::log(fit->spread * standard_quantile(Shape::normal, 0.75));
}

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

Result<void> check(const PowerAssumptions& assumed) {
  for (const double weber : assumed.weber)
    if (!(weber >= 0.01 && weber <= 2))
      return fail(ErrorKind::usage, fmt::format("{:g} % is not from 1 % to 200 %", 100 * weber), "--weber");
  if (assumed.weber[0] == assumed.weber[1])
    return fail(ErrorKind::usage, "there is no difference to find", "--weber",
                "give for example 15.5%,25.3%");
  if (!(assumed.spread >= 0 && assumed.spread <= 2))
    return fail(ErrorKind::usage, "is not from 0 % to 200 %", "--spread");
  if (const double lapse = assumed.lapse.value_or(0); lapse >= 0 && lapse <= 0.5) return {};
  return fail(ErrorKind::usage, "is not from 0 % to 50 %", "--lapse");
}

// Whether Student's t of a mean with this variance is beyond `reach`.
bool is_found(double mean, double variance_of_mean, double reach) {
  return mean * mean > reach * reach * variance_of_mean;
}

// Studies with people drawn from those that were simulated: the share that finds the difference.
StudyPower::Row row_of(int people, const std::array<std::vector<double>, 2>& logs, Draws& draws) {
  const auto n = static_cast<std::size_t>(people);
  const auto reach_of = [](std::size_t freedom) { return student_reach(static_cast<double>(freedom)); };
  const double reach_of_groups = reach_of(2 * n - 2), reach_of_twice = reach_of(n - 1);
  const auto drawn = [&] {
    return static_cast<std::size_t>(draws.uniform() * static_cast<double>(logs[0].size()));
  };
  std::vector<double> one(n), other(n), differences(n);
  int groups = 0, twice = 0;
  for (int study = 0; study < kSimulatedStudies; ++study) {
    for (std::size_t i = 0; i < n; ++i) {
      one[i] = logs[0][drawn()];
      other[i] = logs[1][drawn()];
      const std::size_t both = drawn();
      differences[i] = logs[1][both] - logs[0][both];
    }
    const double a = deviation_of(one), b = deviation_of(other), d = deviation_of(differences);
    groups += is_found(mean_of(other) - mean_of(one), (a * a + b * b) / people, reach_of_groups) ? 1 : 0;
    twice += is_found(mean_of(differences), d * d / people, reach_of_twice) ? 1 : 0;
  }
  return {people, static_cast<double>(groups) / kSimulatedStudies,
          static_cast<double>(twice) / kSimulatedStudies};
}

void add_rows(StudyPower& power, const std::array<std::vector<double>, 2>& logs, Draws& draws) {
  for (int people = 3; people <= kMostPeople && !(power.a_group && power.twice); ++people) {
    power.rows.push_back(row_of(people, logs, draws));
    if (!power.a_group && power.rows.back().groups >= kPowerGoal) power.a_group = people;
    if (!power.twice && power.rows.back().twice >= kPowerGoal) power.twice = people;
  }
}

}  // namespace

Result<StudyPower> study_power(const schema::Protocol& protocol, const PowerAssumptions& assumed,
                               const std::function<void(double)>& tell) {
  TACTO_TRY(check(assumed));
  if (protocol.task != schema::Task::two_interval)
    return schema::fail(schema::ErrorKind::unsuitable,
                        fmt::format("the task {} has no Weber fraction", schema::word_of(protocol.task)),
                        "STUDY", "power is for protocols of two intervals, such as 'new stretch'");
  if (protocol.method != schema::LevelMethod::constant)
    return schema::fail(schema::ErrorKind::unsuitable,
                        fmt::format("the method {} is not simulated", schema::word_of(protocol.method)),
                        "STUDY", "power is for levels that are constant");
  Draws draws(assumed.seed);
  PsychometricOptions fit;
  if (!assumed.lapse) fit.lapse = 0;
  fit.threshold = known_pse(protocol);
  StudyPower power;
  std::array<std::vector<double>, 2> logs;
  std::vector<double> differences;
  for (int person = 0; person < kSimulatedPeople; ++person) {
    const double factor = std::exp(assumed.spread * draws.normal());
    std::array<std::optional<double>, 2> both;
    for (std::size_t i = 0; i < 2; ++i)
      both[i] =
          log_of_fit(answers_of(protocol, assumed.weber[i] * factor, assumed.lapse.value_or(0), draws), fit);
    tell(static_cast<double>(person + 1) / kSimulatedPeople);
    if (!both[0] || !both[1]) {
      ++power.unfitted;
      continue;
    }
    logs[0].push_back(*both[0]);
    logs[1].push_back(*both[1]);
    differences.push_back(*both[1] - *both[0]);
  }
  if (power.unfitted > kSimulatedPeople / 2)
    return fail(ErrorKind::unsuitable,
                fmt::format("{} of {} simulated people can't be fitted", power.unfitted, kSimulatedPeople),
                "--weber",
                "these levels do not show such Weber fractions: change the levels of the protocol");
  for (std::size_t i = 0; i < 2; ++i) {
    power.weber[i] = std::exp(mean_of(logs[i]));
    power.spread[i] = deviation_of(logs[i]);
  }
  power.spread_of_difference = deviation_of(differences);
  add_rows(power, logs, draws);
  return power;
}

}  // namespace tacto::analysis

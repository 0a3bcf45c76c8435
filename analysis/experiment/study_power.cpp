// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/study_power.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <random>
#include <span>

#include "analysis/psychometrics/psychometric_fit.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kMostNoncentrality = 30;  // beyond it the power is 1 with three people, too

// Draws that are the same on any machine (std's distributions are not).
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  double uniform() { return (static_cast<double>(random_() >> 12U) + 0.5) * 0x1p-52; }
  double normal() { return boost::math::quantile(boost::math::normal(), uniform()); }

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
std::optional<double> log_of_fit(std::vector<LevelCount> answers) {
  const auto fit = fit_psychometric(std::move(answers), {});
  if (!fit) return std::nullopt;
  return std::log(fit->spread.value * standard_quantile(Shape::normal, 0.75));
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
  if (assumed.lapse >= 0 && assumed.lapse <= 0.5) return {};
  return fail(ErrorKind::usage, "is not from 0 % to 50 %", "--lapse");
}

void add_rows(StudyPower& power) {
  const double effect = std::abs(std::log(power.weber[1] / power.weber[0]));
  const double variance = power.spread[0] * power.spread[0] + power.spread[1] * power.spread[1];
  for (int people = 3; people <= kMostPeople && !(power.a_group && power.twice); ++people) {
    const double n = people;
    StudyPower::Row& row = power.rows.emplace_back();
    row.people = people;
    row.groups = power_of_t(2 * n - 2, effect / std::sqrt(variance / n));
    row.twice = power_of_t(n - 1, effect / (power.spread_of_difference / std::sqrt(n)));
    if (!power.a_group && row.groups >= kPowerGoal) power.a_group = people;
    if (!power.twice && row.twice >= kPowerGoal) power.twice = people;
  }
}

}  // namespace

double power_of_t(double freedom, double noncentrality) {
  const double reach = boost::math::quantile(boost::math::students_t(freedom), 0.975);
  const boost::math::non_central_t statistic(freedom, std::min(noncentrality, kMostNoncentrality));
  return boost::math::cdf(boost::math::complement(statistic, reach)) + boost::math::cdf(statistic, -reach);
}

Result<StudyPower> study_power(const schema::Protocol& protocol, const PowerAssumptions& assumed,
                               const std::function<void(double)>& tell) {
  TACTO_TRY(check(assumed));
  Draws draws(assumed.seed);
  StudyPower power;
  std::array<std::vector<double>, 2> logs;
  std::vector<double> differences;
  for (int person = 0; person < kSimulatedPeople; ++person) {
    const double factor = std::exp(assumed.spread * draws.normal());
    std::array<std::optional<double>, 2> both;
    for (std::size_t i = 0; i < 2; ++i)
      both[i] = log_of_fit(answers_of(protocol, assumed.weber[i] * factor, assumed.lapse, draws));
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
  add_rows(power);
  return power;
}

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive procedures, information, d', preferences and concordance against published runs and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "analysis/psychometrics/adjustment.hpp"
#include "analysis/psychometrics/alternatives.hpp"
#include "analysis/psychometrics/concordance.hpp"
#include "analysis/psychometrics/confusion.hpp"
#include "analysis/psychometrics/over_people.hpp"
#include "analysis/psychometrics/preference_scale.hpp"
#include "analysis/psychometrics/quest_plus.hpp"
#include "analysis/psychometrics/staircase.hpp"
#include "tests/analysis/psychometric_observers.hpp"

namespace tacto::analysis {
namespace {

using PsyJson = nlohmann::json;

// [first, last, step], or one value.
std::vector<double> values_in(const PsyJson& range) {
  if (range.is_number()) return {range.get<double>()};
  std::vector<double> values;
  for (double value = range[0]; value <= range[1].get<double>() + 1e-9; value += range[2].get<double>())
    values.push_back(value);
  return values;
}

// One published run: its stimuli and all combinations of its parameters, the last named fastest.
struct PublishedRun {
  explicit PublishedRun(const PsyJson& run)
      : weibull(run["function"] == "weibull"), stimuli(values_in(run["stimulus"])) {
    names = weibull ? std::vector<std::string>{"threshold", "slope", "guess", "lapse"}
                    : std::vector<std::string>{"mean", "sd", "lapse"};
    grid = {{}};
    for (const std::string& name : names) {
      std::vector<std::vector<double>> longer;
      for (const auto& row : grid)
        for (const double value : values_in(run["parameters"][name])) {
          longer.push_back(row);
          longer.back().push_back(value);
        }
      grid = longer;
    }
  }

  double chance(std::size_t stimulus, std::size_t parameters) const {
    const double x = stimuli[stimulus];
    const auto& p = grid[parameters];
    if (weibull) return 1 - p[3] - (1 - p[2] - p[3]) * std::exp(-std::pow(10, p[1] * (x - p[0]) / 20));
    return p[2] + (1 - 2 * p[2]) * 0.5 * std::erfc(-(x - p[0]) / p[1] / std::sqrt(2.0));
  }

  bool weibull;
  std::vector<double> stimuli;
  std::vector<std::string> names;
  std::vector<std::vector<double>> grid;
};

TEST(QuestPlus, ChoosesThe352StimuliOfWatson2017) {
  std::ifstream file(TACTO_DATA "/psychophysics/watson2017.json");
  const PsyJson published_runs = PsyJson::parse(file);
  std::size_t trials = 0;
  for (const PsyJson& run : published_runs["runs"]) {
    const PublishedRun published(run);
    QuestPlus quest(published.stimuli.size(), published.grid.size(),
                    [&](std::size_t s, std::size_t p) { return published.chance(s, p); });
    for (std::size_t trial = 0; trial < run["chosen"].size(); ++trial, ++trials) {
      const std::size_t next = quest.next();
      ASSERT_EQ(published.stimuli[next], run["chosen"][trial].get<double>()) << trials;
      quest.take_answer(next, run["correct"][trial] == 1);
    }
    const auto& mode = published.grid[quest.mode()];
    for (const auto& [name, value] : run["mode"].items())
      EXPECT_NEAR(
          mode[static_cast<std::size_t>(std::ranges::find(published.names, name) - published.names.begin())],
          value.get<double>(), 1e-9)
          << name;
  }
  EXPECT_EQ(trials, 352U);
}

// Where a staircase settles: p^2 = 1/2, p^3 = 1/2, p = 3/4. Steps of 0.5 dB; the observer's threshold is at 0
// dB. A million trials: 1 / 1000 at most by chance.
TEST(Staircase, SettlesWhereItsRuleSays) {
  struct Case {
    StaircaseRule rule;
    double proportion;
  };
  const Case kCases[] = {
      {{2, 1, 0.5, 0.5}, std::sqrt(0.5)}, {{3, 1, 0.5, 0.5}, std::cbrt(0.5)}, {{1, 1, 1.5, 0.5}, 0.75}};
  for (const Case& each : kCases) {
    ObserverDraws draws(3);
    Staircase staircase(each.rule, 10);
    constexpr int kTrials = 1000000;
    int right = 0;
    for (int i = 0; i < kTrials; ++i) {
      const bool correct = draws.uniform() < 1 - std::exp(-std::pow(10, 3.5 * staircase.level() / 20));
      right += correct;
      staircase.take_answer(correct);
    }
    EXPECT_NEAR(right / double{kTrials}, each.proportion, 0.002);
  }
}

// The level of a reversal is the one at which the answer was given (PsychoPy #34).
TEST(Staircase, RecordsTheLevelsThatWerePresented) {
  Staircase staircase({2, 1, 1, 1}, 10);
  std::vector<double> levels;
  for (const bool correct : {true, true, true, true, false, true, true, false, false}) {
    levels.push_back(staircase.level());
    staircase.take_answer(correct);
  }
  EXPECT_EQ(levels, (std::vector<double>{10, 10, 9, 9, 8, 9, 9, 8, 9}));
  EXPECT_EQ(staircase.reversals(), (std::vector<double>{8, 9, 8}));
  EXPECT_EQ(staircase.level(), 10);
}

TEST(Information, OfPerfectAnswersIsThatOfTheStimuli) {
  ConfusionMatrix matrix(5, std::vector<double>(5, 0));
  for (std::size_t i = 0; i < 5; ++i) matrix[i][i] = 33;
  const Information information = information_of(matrix);
  EXPECT_NEAR(information.plug_in, std::log2(5), 1e-12);
  EXPECT_NEAR(information.jackknife, std::log2(5), 1e-12);
}

// Answers that are right with probability `right`, else any other with equal chance: log2 k + right log2
// right + (1 - right) log2((1 - right) / (k - 1)) bit. 33 answers a stimulus; the mean of 400 matrices is
// within 0.005.
TEST(Information, JackknifeRemovesTheBias) {
  constexpr int kMatrices = 400;
  for (const double right : {0.3, 0.6, 0.8, 0.93}) {
    ObserverDraws draws(5);
    const double truth = std::log2(5) + right * std::log2(right) + (1 - right) * std::log2((1 - right) / 4);
    Information sum;
    for (int i = 0; i < kMatrices; ++i) {
      ConfusionMatrix matrix(5, std::vector<double>(5, 0));
      for (std::size_t s = 0; s < 5; ++s)
        for (int trial = 0; trial < 33; ++trial) {
          const bool correct = draws.uniform() < right;
          const auto other = (s + 1 + static_cast<std::size_t>(4 * draws.uniform())) % 5;
          matrix[s][correct ? s : other] += 1;
        }
      const Information one = information_of(matrix);
      sum.plug_in += one.plug_in / kMatrices;
      sum.miller_madow += one.miller_madow / kMatrices;
      sum.jackknife += one.jackknife / kMatrices;
    }
    EXPECT_NEAR(sum.jackknife, truth, 0.04) << right;
    EXPECT_GT(sum.plug_in - truth, 0.06) << right;  // the bias that is removed
    EXPECT_LT(std::abs(sum.miller_madow - truth), sum.plug_in - truth) << right;
  }
}

// SciPy: quad(lambda x: norm.pdf(x - 2) * norm.cdf(x)**4, -12, 14). Two alternatives: Phi(d' / sqrt 2).
TEST(Alternatives, ProportionCorrectIsTheQuadrature) {
  EXPECT_NEAR(proportion_correct(2, 5), 0.787838982709588, 1e-9);
  for (const double d_prime : {-1.5, 0.0, 0.7, 3.0})
    EXPECT_NEAR(proportion_correct(d_prime, 2), 0.5 * std::erfc(-d_prime / 2), 1e-9);
  EXPECT_NEAR(proportion_correct(0, 3), 1 / 3.0, 1e-9);
  const auto back = d_prime_of(proportion_correct(1.7, 4), 4);
  ASSERT_TRUE(back);
  EXPECT_NEAR(*back, 1.7, 1e-6);
  EXPECT_FALSE(d_prime_of(1, 4));
  EXPECT_FALSE(d_prime_of(0, 4));
}

// SciPy: friedmanchisquare(*scores.T); W is its statistic over people (items - 1).
TEST(Concordance, IsFriedmansTest) {
  const Concordance found =
      concordance_of({{1, 2, 3, 4, 5}, {2, 1, 3, 5, 4}, {1, 1, 2, 5, 3}, {3, 2, 2, 4, 5}});
  EXPECT_NEAR(found.w, 0.8365384615384623, 1e-12);
  EXPECT_NEAR(found.chi_squared, 13.384615384615397, 1e-12);
  EXPECT_NEAR(found.p, 0.009541668975699706, 1e-12);
  EXPECT_EQ(found.freedom, 4U);
  EXPECT_NEAR(concordance_of({{1, 2, 3}, {10, 20, 30}}).w, 1, 1e-12);
  EXPECT_EQ(concordance_of({{1, 1, 1}, {2, 2, 2}}).w, 0);
}

// SciPy: spearmanr, kendalltau (tau-b).
TEST(Concordance, TwoOrdersAreCorrelated) {
  const std::vector<double> a = {1, 2, 3, 4, 5, 6}, b = {1.5, 1.5, 4, 3, 6, 5}, same(6, 2);
  EXPECT_NEAR(spearman_rho(a, b).value(), 0.8696565534786727, 1e-12);
  EXPECT_NEAR(kendall_tau(a, b).value(), 0.6900655593423543, 1e-12);
  EXPECT_NEAR(spearman_rho(a, {{6, 5, 4, 3, 2, 1}}).value(), -1, 1e-12);
  EXPECT_NEAR(kendall_tau(a, {{6, 5, 4, 3, 2, 1}}).value(), -1, 1e-12);
  EXPECT_FALSE(spearman_rho(a, same));
  EXPECT_FALSE(kendall_tau(same, b));
  EXPECT_EQ(ranks_of(b), (std::vector<double>{1.5, 1.5, 4, 3, 6, 5}));
  // 7/3 by two sums of thirds, which differ by rounding, are a tie.
  EXPECT_EQ(ranks_of(std::vector<double>{1.0 / 3 + 2.0 / 3 + 4.0 / 3, 1.0 / 3 + 1.0 / 3 + 5.0 / 3, 3}),
            (std::vector<double>{1.5, 1.5, 3}));
}

// NumPy and SciPy: means and deviations of 20 log10, t.ppf(0.975), and Welch's degrees of freedom, 4.868.
// With two degrees of freedom t has a closed form, 0.95 sqrt(2 / (4 0.975 0.025)); SciPy's differs from it
// by 1.6e-10.
TEST(Adjustment, SeriesHaveMeansAndADifference) {
  const std::vector<double> up = {0.2, 0.22, 0.25, 0.19}, down = {0.26, 0.3, 0.28};
  const AdjustmentMeans means = adjustment_means(up, down);
  const auto expect = [](const Estimate& found, double value, double low, double high) {
    EXPECT_NEAR(found.value, value, 1e-12);
    EXPECT_NEAR(found.low, low, 1e-12);
    EXPECT_NEAR(found.high, high, 1e-12);
  };
  EXPECT_EQ(means.ascending->settings, 4U);
  expect(means.ascending->ratio, 0.21381421328492134, 0.1764675659654232, 0.2590647043412355);
  EXPECT_NEAR(means.ascending->deviation_db.value(), 1.0478942054610423, 1e-12);
  expect(means.descending->ratio, 0.279522997372737, 0.23399637480886956, 0.33390733563312243);
  expect(means.hysteresis_db.value(), 2.3276194629960614, 0.6817081006621684, 3.9735308253299544);
  expect(means.middle.value(), 0.24447083625310995, 0.22237157600812815, 0.2687663183000975);
}

TEST(Adjustment, WhatOneSettingCannotSayIsUnlimited) {
  const AdjustmentMeans one = adjustment_means({{0.2}}, {{0.4, 0.4}});
  EXPECT_FALSE(one.ascending->deviation_db);
  EXPECT_NEAR(one.hysteresis_db->value, 20 * std::log10(2), 1e-12);
  EXPECT_EQ(one.hysteresis_db->high, INFINITY);
  const AdjustmentMeans none = adjustment_means({}, {{0.4, 0.5}});
  EXPECT_FALSE(none.ascending || none.middle || none.hysteresis_db);
  EXPECT_TRUE(none.descending);
  const AdjustmentMeans equal = adjustment_means({{0.2, 0.2}}, {{0.2, 0.2}});
  EXPECT_NEAR(equal.middle->high, 0.2, 1e-12);
  EXPECT_NEAR(equal.hysteresis_db->low, 0, 1e-12);
}

TEST(PreferenceScale, TwoItemsHaveTheLogarithmOfTheirOdds) {
  const auto scale = fit_preferences(std::vector<Preference>{{"a", "b", 30}, {"b", "a", 10}});
  ASSERT_TRUE(scale);
  EXPECT_EQ(scale->items[0].name, "a");
  EXPECT_NEAR(scale->items[0].ability.value, std::log(3), 1e-9);
  const double error = std::sqrt(1 / 30.0 + 1 / 10.0);  // of a logarithm of odds
  EXPECT_NEAR(scale->items[0].ability.high, std::log(3) + 1.959964 * error, 1e-6);
  EXPECT_EQ(scale->items[1].ability.value, 0);
}

TEST(PreferenceScale, WithoutContradictionThereIsNoScale) {
  const std::vector<Preference> kUnbounded[] = {
      {{"a", "b", 3}, {"b", "c", 2}, {"c", "b", 1}, {"a", "c", 1}},  // a always wins
      {{"a", "b", 1}, {"b", "a", 1}, {"c", "d", 1}, {"d", "c", 1}},  // two groups that never met
      {{"a", "a", 1}},
      {},
  };
  for (const auto& preferences : kUnbounded) {
    const auto scale = fit_preferences(preferences);
    ASSERT_FALSE(scale);
    EXPECT_EQ(scale.error().kind, schema::ErrorKind::unsuitable);
  }
}

// Logarithms 0, 1, 2: mean 1, standard error 1 / sqrt 3, t 4.302653 with 2 degrees of freedom.
TEST(OverPeople, TheMeanOfLogarithmsIsStudents) {
  const std::vector<double> figures = {1, std::exp(1), std::exp(2)};
  const Estimate mean = geometric_mean(figures);
  EXPECT_NEAR(mean.value, std::exp(1), 1e-12);
  EXPECT_NEAR(std::log(mean.high), 1 + 4.302652729911275 / std::sqrt(3), 1e-9);
  const PairedTest test = paired_log_test(figures, std::vector<double>{1, 1, 1});
  EXPECT_NEAR(test.t, std::sqrt(3), 1e-12);
  EXPECT_NEAR(test.p, 0.22540333075851657, 1e-12);  // scipy.stats.t.sf(3**.5, 2) * 2
  EXPECT_TRUE(std::isinf(geometric_mean(std::vector<double>{2}).high));
}

}  // namespace
}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Fits of psychometric functions: psignifit's published example, exact proportions, and answers that give
// only a bound.
#include "analysis/psychometrics/psychometric_fit.hpp"
#include "analysis/experiment/answers_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/psychometric_observers.hpp"

namespace tacto::analysis {
namespace {

PsychometricOptions guessing(double guess) {
  PsychometricOptions options;
  options.guess = guess;
  return options;
}

double width_of(const PsychometricFit& fit) {
  return fit.function.level_at(0.95) - fit.function.level_at(0.05);
}

// The MATLAB version of psignifit 4 (shared/data/psychophysics/README.md). Bars of issue 36: 0.1 % and 1 % of
// the estimates, whose prior of the lapse differs, and 1.5 % of the ends of the intervals.
TEST(PsychometricFit, PsignifitsExampleAsPublished) {
  PsychometricOptions options = guessing(0.5);
  options.overdispersed = true;
  const auto fit = fit_psychometric({{0.001, 45, 90},
                                     {0.0015, 50, 90},
                                     {0.002, 44, 90},
                                     {0.0025, 44, 90},
                                     {0.003, 52, 90},
                                     {0.0035, 53, 90},
                                     {0.004, 62, 90},
                                     {0.0045, 64, 90},
                                     {0.005, 76, 90},
                                     {0.006, 79, 90},
                                     {0.007, 88, 90},
                                     {0.008, 90, 90},
                                     {0.01, 90, 90}},
                                    options);
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_NEAR(fit->threshold.value, 0.00464485, 1e-3 * 0.00464485);
  EXPECT_NEAR(width_of(*fit), 0.00468384, 1e-2 * 0.00468384);
  EXPECT_NEAR(fit->threshold.low, 0.00428294, 1.5e-2 * 0.00428294);
  EXPECT_NEAR(fit->threshold.high, 0.00496425, 1.5e-2 * 0.00496425);
  const double per_spread = width_of(*fit) / fit->spread.value;
  EXPECT_NEAR(fit->spread.low * per_spread, 0.00353217, 1.5e-2 * 0.00353217);
  EXPECT_NEAR(fit->spread.high * per_spread, 0.00604091, 1.5e-2 * 0.00604091);
}

// Counts in proportion to a function have their maximum there, if the priors of lapse and overdispersion do
// not pull: with the lapse fixed at its own value. The counts are no whole numbers.
TEST(PsychometricFit, FindsTheFunctionOfExactProportions) {
  for (const Shape shape : {Shape::normal, Shape::logistic, Shape::weibull})
    for (const std::optional<double> guess : {std::optional<double>(), std::optional<double>(0.5)}) {
      const PsychometricFunction truth{shape, std::log(4), 0.6, 0.03, guess};
      std::vector<LevelCount> levels;
      for (const double level : {0.3, 0.9, 1.4, 2.0, 3.0, 4.4, 7.0})
        levels.push_back({level, 40 * truth(level), 40});
      PsychometricOptions options{shape, guess, 0.03, false};
      const auto fit = fit_psychometric(levels, options);
      ASSERT_TRUE(fit) << fit.error().what;
      EXPECT_NEAR(fit->function.centre, truth.centre, 1e-7);
      EXPECT_NEAR(fit->function.spread, truth.spread, 1e-7);
      EXPECT_NEAR(fit->deviance, 0, 1e-10);
      EXPECT_EQ(fit->freedom, 5U);
      EXPECT_LT(fit->threshold.low, fit->threshold.value);
      EXPECT_GT(fit->threshold.high, fit->threshold.value);
    }
}

// Answers that scatter with the variance of a beta-binomial distribution of eta 0.2, exactly: at each level
// half of the blocks one standard deviation above and half below.
TEST(PsychometricFit, OverdispersionWidensTheIntervals) {
  const PsychometricFunction truth{Shape::normal, 0, 1, 0, {}};
  std::vector<LevelCount> levels;
  for (int i = -8; i <= 8; ++i) {
    const double level = 0.3 * i, p = truth(level), sigma = std::sqrt(40 * p * (1 - p) * (1 + 39 * 0.04));
    levels.push_back({level, std::clamp(40 * p + (i % 2 == 0 ? sigma : -sigma), 0.0, 40.0), 40});
  }
  PsychometricOptions options;
  const auto binomial = fit_psychometric(levels, options);
  options.overdispersed = true;
  const auto scattered = fit_psychometric(levels, options);
  ASSERT_TRUE(binomial && scattered);
  EXPECT_LT(binomial->p, 0.01);
  EXPECT_NEAR(scattered->overdispersion, 0.2, 0.07);  // 17 levels: a variance within 35 %
  EXPECT_GT(scattered->overdispersion_high, scattered->overdispersion);
  EXPECT_GT(scattered->threshold.high - scattered->threshold.low,
            1.3 * (binomial->threshold.high - binomial->threshold.low));
}

TEST(PsychometricFit, LevelsAreAddedAndSorted) {
  const auto fit = fit_psychometric({{3, 9, 10}, {1, 1, 10}, {2, 2, 5}, {2, 4, 5}}, {});
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->levels.size(), 3U);
  EXPECT_EQ(fit->levels[1].level, 2);
  EXPECT_EQ(fit->levels[1].yes, 6);
  EXPECT_EQ(fit->levels[1].trials, 10);
}

TEST(PsychometricFit, ABoundIsNoThreshold) {
  const std::vector<std::vector<LevelCount>> kBounds = {
      {{1, 10, 10}, {2, 10, 10}},                                // all yes
      {{1, 0, 10}, {2, 0, 10}},                                  // all no
      {{1, 0, 10}, {2, 0, 10}, {3, 10, 10}, {4, 10, 10}},        // a step
      {{1, 0, 10}, {2, 0, 10}, {3, 7, 10}, {4, 10, 10}},         // a step at a level
      {{1, 7, 10}, {2, 10, 10}, {3, 10, 10}},                    // at the first one
      {{1, 1, 20}, {2, 0, 20}, {3, 7, 20}, {4, 20, 20}},         // with a lapse
      {{1, 9, 10}, {2, 5, 10}, {3, 2, 10}},                      // falls
      {{1, 5, 10}},                                              // one level
      {{1, 50, 100}, {2, 50, 100}, {3, 51, 100}},                // depends too little on the level
      {{1, 1, 1000}, {2, 2, 1000}, {3, 4, 1000}, {4, 7, 1000}},  // threshold far beyond the levels
  };
  for (const auto& levels : kBounds) {
    const auto fit = fit_psychometric(levels, {});
    ASSERT_FALSE(fit) << levels.size();
    EXPECT_EQ(fit.error().kind, schema::ErrorKind::unsuitable);
  }
  PsychometricOptions weibull;
  weibull.shape = Shape::weibull;
  EXPECT_FALSE(fit_psychometric({{0, 1, 10}, {1, 5, 10}, {2, 9, 10}}, weibull));
}

PsychometricOptions at_zero() {
  PsychometricOptions options;
  options.threshold = 0;
  return options;
}

// The maximum of the likelihood of one parameter, by scipy.optimize.minimize_scalar; the mirrored answers are
// the same.
TEST(PsychometricFit, AFixedThresholdLeavesTheSpread) {
  std::vector<LevelCount> above = {
      {0.05, 11, 20}, {0.1, 13, 20}, {0.2, 15, 20}, {0.4, 18, 20}, {0.7, 20, 20}};
  std::vector<LevelCount> below;
  for (const auto& [level, yes, trials] : above) below.push_back({-level, trials - yes, trials});
  PsychometricOptions options = at_zero();
  options.lapse = 0;
  for (const auto& levels : {above, below}) {
    const auto fit = fit_psychometric(levels, options);
    ASSERT_TRUE(fit) << fit.error().what;
    EXPECT_EQ(fit->threshold.value, 0);
    EXPECT_EQ(fit->threshold.low, 0);
    EXPECT_EQ(fit->threshold.high, 0);
    EXPECT_NEAR(fit->spread.value, 0.28863946277566, 1e-7);
    EXPECT_TRUE(fit->spread.low < fit->spread.value && fit->spread.value < fit->spread.high);
    EXPECT_EQ(fit->freedom, 4U);
  }
  EXPECT_NEAR(fit_psychometric(above, options)->spread.low, fit_psychometric(below, options)->spread.low,
              1e-9);
  AnswersTable table;
  table.groups = {{{}, above}};
  table.pse = 0;
  PsychometricOptions no_lapse;
  no_lapse.lapse = 0;
  const auto of_table = fit_answers(table, no_lapse, [](double) {});
  ASSERT_TRUE(of_table);
  EXPECT_EQ(of_table->groups.front().fit.threshold.value, 0);
}

// Levels on one side, as of a staircase: 200 observers whose intervals of 95 % contain the true spread. The
// standard error of a share of 200 is 1.5 %; the limit is four of them below 95 %.
TEST(PsychometricFit, AFixedThresholdKeepsTheCoverage) {
  ObserverDraws draws(7);
  const double spread = 0.253 / standard_quantile(Shape::normal, 0.75);
  int covered = 0;
  for (int observer = 0; observer < 200; ++observer) {
    const double inattentive = draws.between(0.01, 0.03);
    const PsychometricFunction truth{Shape::normal, 0, spread, inattentive / 2, {}};
    std::vector<LevelCount> levels;
    for (const double stretch : {0.1, 0.2, 0.3, 0.4, 0.5, 0.7}) {
      LevelCount& level = levels.emplace_back(LevelCount{stretch, 0, 15});
      for (int i = 0; i < 15; ++i) level.yes += draws.uniform() < truth(stretch);
    }
    const auto fit = fit_psychometric(levels, at_zero());
    covered += fit && fit->spread.low <= spread && spread <= fit->spread.high;
  }
  EXPECT_GE(covered, 178);
}

TEST(PsychometricFit, WithAFixedThresholdABoundIsNoSpread) {
  const std::vector<std::vector<LevelCount>> kBounds = {
      {{0.1, 10, 10}, {0.2, 10, 10}},     // all right
      {{-0.2, 0, 10}, {-0.1, 0, 10}},     // all right
      {{0.1, 10, 10}, {0.2, 9, 10}},      // all but one, which is a lapse
      {{0.1, 5, 10}, {0.2, 5, 10}},       // guesses
      {{-0.2, 10, 10}, {-0.1, 10, 10}}};  // wrong
  for (std::size_t i = 0; i < kBounds.size(); ++i) {
    const auto fit = fit_psychometric(kBounds[i], at_zero());
    ASSERT_FALSE(fit) << i;
    EXPECT_EQ(fit.error().kind, schema::ErrorKind::unsuitable);
  }
}

TEST(PsychometricFit, InAStudyAPersonWithABoundIsLeftOut) {
  const std::vector<LevelCount> slope = {{1, 2, 20}, {2, 5, 20}, {3, 9, 20}, {4, 15, 20}, {5, 19, 20}},
                                bound = {{1, 10, 10}, {2, 10, 10}};
  AnswersTable table;
  table.groups = {{{"P01"}, bound}, {{"P02"}, slope}, {{"P03"}, slope}};
  const auto fitted = [&] { return fit_answers(table, {}, [](double) {}); };
  EXPECT_EQ(fitted().error().where, "P01");
  table.of_study = true;
  const auto all = fitted();
  ASSERT_TRUE(all);
  ASSERT_EQ(all->groups.size(), 2U);
  EXPECT_EQ(all->groups[0].by.front(), "P02");
  ASSERT_EQ(all->not_fitted.size(), 1U);
  EXPECT_TRUE(all->not_fitted[0].starts_with("P01: "));
  EXPECT_EQ(all->over_people->conditions[0].people.size(), 2U);
  table.groups.resize(1);
  EXPECT_EQ(fitted().error().where, "P01");
}

}  // namespace
}  // namespace tacto::analysis

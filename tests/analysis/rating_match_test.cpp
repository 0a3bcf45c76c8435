// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/rating_match.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "analysis/psychometrics/psychometric_function.hpp"

namespace tacto::analysis {
namespace {

// Ratings of ratios from 0 to 2 with normal errors: 0 within `half` of the match.
std::vector<RatedRatio> rated_ratios(std::mt19937_64& random, int trials, double match, double spread,
                                     double half) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 12U) + 0.5) * 0x1p-52; };
  std::vector<RatedRatio> ratings;
  for (int i = 0; i < trials; ++i) {
    const double ratio = 2 * uniform();
    const double away = ratio - match + spread * standard_quantile(Shape::normal, uniform());
    ratings.push_back({ratio, away < -half ? -1 : away > half ? 1 : 0});
  }
  return ratings;
}

// Of 200 simulated people each. The bound: 95 % of 200, less 4 standard deviations of a
// binomial count, 3.1.
TEST(RatingMatch, IntervalsCoverTheTruth) {
  std::mt19937_64 random(36);
  for (const auto& [spread, half] : {std::pair{0.05, 0.167}, {0.2, 0.167}, {0.4, 0.1}}) {
    int covered = 0;
    for (int person = 0; person < 200; ++person) {
      const auto match = match_of_ratings(rated_ratios(random, 40, 0.86, spread, half));
      ASSERT_TRUE(match) << schema::message(match.error());
      covered += match->low <= 0.86 && 0.86 <= match->high ? 1 : 0;
    }
    RecordProperty("covered", covered);
    EXPECT_GE(covered, 178) << spread;
  }
}

// The mean ratio of zeros depends on which ratios were asked, the match does not.
TEST(RatingMatch, MatchDoesNotDependOnWhichRatiosWereAsked) {
  std::mt19937_64 random(37);
  std::vector<RatedRatio> ratings = rated_ratios(random, 1000, 0.86, 0.15, 0.3);
  std::erase_if(ratings, [](const RatedRatio& each) { return each.ratio > 0.9 && each.ratio < 1.3; });
  double zeros = 0, sum = 0;
  for (const RatedRatio& each : ratings)
    if (each.rating == 0) ++zeros, sum += each.ratio;
  const auto match = match_of_ratings(ratings);
  ASSERT_TRUE(match);
  EXPECT_LT(sum / zeros, 0.8);
  EXPECT_NEAR(match->value, 0.86, 0.05);  // three standard errors of 0.016
}

TEST(RatingMatch, ABoundIsRefused) {
  for (const std::vector<RatedRatio>& ratings :
       {std::vector<RatedRatio>{}, {{0.5, 1}, {1.5, 1}}, {{0.5, 0}, {1.5, 1}}, {{0.5, -1}, {1.5, 0}}}) {
    const auto match = match_of_ratings(ratings);
    ASSERT_FALSE(match);
    EXPECT_EQ(match.error().kind, schema::ErrorKind::unsuitable);
  }
  EXPECT_FALSE(match_of_ratings(std::vector<RatedRatio>{{1, -1}, {1, 1}}));
}

}  // namespace
}  // namespace tacto::analysis

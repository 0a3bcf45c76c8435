// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/rating_match.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr std::size_t kMatchSteps = 200;   // a step is 0.5 % of the range
constexpr std::size_t kHalfWidthStep = 4;  // of h, in steps of the match
constexpr std::size_t kSpreadNodes = 20;
// From half a step of the match to half of the range, each 1.32 times the one before.
constexpr double kLeastSpread = 1.0 / 400;
// Lapses at the middles of four equal parts of the prior Beta(1, 19): 1 - (1 - part)^(1 / 19).
constexpr std::size_t kLapseNodes = 4;

double normal_cdf(double z) {
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

double lapse_at(std::size_t i) {
  const double part = (static_cast<double>(i) + 0.5) / kLapseNodes;
  return 1 - std::pow(1 - part, 1.0 / 19);
}

// P(the noisy ratio is below limit k of this grid), for each k and rating.
class RatingGrid {
 public:
  RatingGrid(std::span<const RatedRatio> ratings, double least, double step)
      : ratings_(ratings), least_(least), step_(step) {}

  void set_spread(double spread) {
    below_.assign((2 * kMatchSteps + 1) * ratings_.size(), 0);
    for (std::size_t k = 0; k <= 2 * kMatchSteps; ++k)
      for (std::size_t i = 0; i < ratings_.size(); ++i)
        below_[k * ratings_.size() + i] = normal_cdf((limit(k) - ratings_[i].ratio) / spread);
  }

  // The limits reach half of the range beyond both of its ends: the match k has the limit k + kMatchSteps
  // / 2.
  double log_likelihood(std::size_t match, std::size_t half, double lapse) const {
    const std::size_t middle = match + kMatchSteps / 2;
    const double* const low = &below_[(middle - half) * ratings_.size()];
    const double* const high = &below_[(middle + half) * ratings_.size()];
    double sum = 0, product = 1;
    for (std::size_t i = 0; i < ratings_.size(); ++i) {
      const double p = ratings_[i].rating < 0   ? lapse / 2 + (1 - lapse) * low[i]
                       : ratings_[i].rating > 0 ? lapse / 2 + (1 - lapse) * (1 - high[i])
                                                : (1 - lapse) * (high[i] - low[i]);
      product *= p;
      if (i % 64 != 63)
        continue;  // by the least lapse of 0.7 % above 1e-157; or 0, by a zero that is impossible
      sum += std::log(product);
      product = 1;
    }
    return sum + std::log(product);
  }

 private:
  double limit(std::size_t k) const {
    constexpr std::size_t kMiddle = kMatchSteps / 2;
    return least_ + step_ * (static_cast<double>(k) - static_cast<double>(kMiddle));
  }

  std::span<const RatedRatio> ratings_;
  double least_, step_;
  std::vector<double> below_;
};

Result<void> check_ratings(std::span<const RatedRatio> ratings) {
  const auto count = [&](auto is) { return std::ranges::count_if(ratings, is, &RatedRatio::rating); };
  const auto below = count([](int rating) { return rating < 0; });
  const auto above = count([](int rating) { return rating > 0; });
  if (below > 0 && above > 0) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("of {} ratings {} are below 0, and {} above it", ratings.size(), below, above), {},
              "this is only a bound of the match: measure where both occur");
}

// The value below which this part of the masses is; each is spread evenly around its place.
double quantile_of(const std::vector<double>& mass, double least, double step, double part) {
  double sum = 0, all = 0;
  for (const double each : mass) all += each;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (sum + mass[i] >= part * all)
      return least + step * (static_cast<double>(i) - 0.5 + (part * all - sum) / mass[i]);
    sum += mass[i];
  }
  return least + step * (static_cast<double>(mass.size()) - 0.5);
}

}  // namespace

Result<Estimate> match_of_ratings(std::span<const RatedRatio> ratings) {
  TACTO_TRY(check_ratings(ratings));
  const auto [low, high] = std::ranges::minmax(ratings, {}, &RatedRatio::ratio);
  const double least = low.ratio, range = high.ratio - least, step = range / kMatchSteps;
  if (!(range > 0))
    return fail(ErrorKind::unsuitable, "all ratings are of one ratio", {}, "measure at several");
  RatingGrid grid(ratings, least, step);
  // Each row: the log of the spread, for the density in s, and the likelihood of each match.
  std::vector<std::array<double, kMatchSteps + 1>> logs;
  double most = -INFINITY;
  for (std::size_t i = 0; i < kSpreadNodes; ++i) {
    const double part = static_cast<double>(i) / (kSpreadNodes - 1);
    const double spread = range * kLeastSpread * std::pow(0.5 / kLeastSpread, part);
    grid.set_spread(spread);
    for (std::size_t half = 0; half <= kMatchSteps / 2; half += kHalfWidthStep)
      for (std::size_t k = 0; k < kLapseNodes; ++k) {
        auto& row = logs.emplace_back();
        for (std::size_t match = 0; match <= kMatchSteps; ++match) {
          row[match] = std::log(spread) + grid.log_likelihood(match, half, lapse_at(k));
          most = std::max(most, row[match]);
        }
      }
  }
  std::vector<double> mass(kMatchSteps + 1, 0);
  for (const auto& row : logs)
    for (std::size_t match = 0; match <= kMatchSteps; ++match) mass[match] += std::exp(row[match] - most);
  return Estimate{quantile_of(mass, least, step, 0.5), quantile_of(mass, least, step, 0.025),
                  quantile_of(mass, least, step, 0.975)};
}

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/psychometric_fit.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "analysis/psychometrics/deviance.hpp"
#include "data-schema/base/raised_cosine.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

// The logarithm of likelihood times the priors of lapse and overdispersion, without constants.
class PsychometricLikelihood {
 public:
  // Both must outlive it. Levels: as in PsychometricFit.
  PsychometricLikelihood(std::span<const LevelCount> levels, const PsychometricOptions& options);

  using Tails = std::vector<std::pair<double, double>>;
  // F and 1 - F at each level.
  Tails tails(double centre, double spread) const;
  // `eta` of 0: binomial answers.
  double at(const Tails& tails, double lapse, double eta) const;

  // Ascending: the levels; beside a fixed threshold also their mirror images, at which F is known as well.
  const std::vector<double>& places() const { return places_; }
  const PsychometricOptions& options() const { return options_; }

 private:
  std::span<const LevelCount> levels_;
  const PsychometricOptions& options_;
  std::vector<double> scaled_, places_;
};

// The place of the maximum.
struct PsychometricPeak {
  double centre = 0, log_spread = 0, lapse = 0, eta = 0;
  double value = 0;
};

// The levels that the prior of threshold and width refers to (Schuett 2016), in scaled levels.
struct LevelRange {
  double least = 0, most = 0;
  double spacing = 0;  ///< the smallest between neighbours, at most a quarter of the range

  double range() const { return most - least; }
};

struct Interval {
  double low = 0, high = 0;
};

struct PosteriorIntervals {
  Interval centre, spread;              ///< 2.5 to 97.5 %
  double lapse_high = 0, eta_high = 0;  ///< 95 %
};

// Beta(1, b): density b (1 - x)^(b - 1). Lapses: mean 5 %; overdispersion: as Schuett 2016.
constexpr double kLapsePrior = 19, kEtaPrior = 10;
constexpr double kMostEta = 0.7;
constexpr double kLeastEta = 1e-3;  // below it the variance differs from the binomial one by n 1e-6

double times_log(double count, double p) {
  return count == 0 ? 0 : count * std::log(p);
}

// Beta-binomial: p scatters with the variance p (1 - p) eta^2.
double scattered(double yes, double no, double p, double q, double counts) {
  const double a = p * counts, b = q * counts;
  if ((yes > 0 && a <= 0) || (no > 0 && b <= 0)) return -INFINITY;
  const double of_yes = yes > 0 ? std::lgamma(yes + a) - std::lgamma(a) : 0;
  const double of_no = no > 0 ? std::lgamma(no + b) - std::lgamma(b) : 0;
  return of_yes + of_no + std::lgamma(counts) - std::lgamma(yes + no + counts);
}

// Climbs from a peak's centre and spread at its lapse and eta.
class Climb {
 public:
  Climb(const PsychometricLikelihood& likelihood, PsychometricPeak start)
      : likelihood_(likelihood), at_(start), lapse_(start.lapse), eta_(start.eta) {
    at_.value = value(at_.centre, at_.log_spread);
  }

  PsychometricPeak top() {
    constexpr int kMostSteps = 60;
    for (int i = 0; i < kMostSteps; ++i)
      if (!step()) break;
    return at_;
  }

 private:
  double value(double centre, double log_spread) const {
    return likelihood_.at(likelihood_.tails(centre, std::exp(log_spread)), lapse_, eta_);
  }

  // One step in (centre / spread, log spread), with derivatives by differences; false at the top.
  bool step() {
    constexpr double kStep = 1e-4, kConverged = 1e-10;
    const double unit = std::exp(at_.log_spread);
    const bool fixed = likelihood_.options().threshold.has_value();
    const auto f = [&](double x, double y) {
      return value(at_.centre + (fixed ? 0 : unit * kStep * x), at_.log_spread + kStep * y);
    };
    const double left = f(-1, 0), right = f(1, 0), below = f(0, -1), above = f(0, 1), here = at_.value;
    const Eigen::Vector2d slope((right - left) / 2, (above - below) / 2);
    const double mixed = (f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / 4;
    Eigen::Matrix2d bend;
    bend << left - 2 * here + right, mixed, mixed, below - 2 * here + above;
    if (fixed) bend(0, 0) = bend(1, 1);  // its slope is 0: the centre stays
    if (!slope.allFinite() || !bend.allFinite()) return false;
    const double size = std::max(bend.cwiseAbs().maxCoeff(), 1e-300);
    for (double damping = 0; damping < 1e8 * size; damping = std::max(1e-3 * size, 10 * damping)) {
      const Eigen::Matrix2d down = damping * Eigen::Matrix2d::Identity() - bend;
      const Eigen::LLT<Eigen::Matrix2d> solver(down);
      if (solver.info() != Eigen::Success) continue;
      const Eigen::Vector2d move = kStep * solver.solve(slope);
      if (move.cwiseAbs().maxCoeff() > 2) continue;
      PsychometricPeak next = at_;
      next.centre += unit * move(0);
      next.log_spread += move(1);
      next.value = value(next.centre, next.log_spread);
      if (!(next.value >= at_.value - 1e-13 * std::abs(at_.value))) continue;
      at_ = next;
      return move.cwiseAbs().maxCoeff() > kConverged;
    }
    return false;
  }

  const PsychometricLikelihood& likelihood_;
  PsychometricPeak at_;
  double lapse_, eta_;
};

// The maximum of `peak_at` from 0 to `most`: the best of some places, then Brent's method between its
// neighbours.
template <class PeakAt>
PsychometricPeak best_peak(double most, PeakAt peak_at) {
  constexpr std::array kPlaces = {0.0, 0.005, 0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 1.0};
  std::size_t best = 0;
  std::array<PsychometricPeak, kPlaces.size()> peaks;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    peaks[i] = peak_at(kPlaces[i] * most, peaks[best]);
    if (peaks[i].value > peaks[best].value) best = i;
  }
  const double low = most * kPlaces[best == 0 ? 0 : best - 1];
  const double high = most * kPlaces[std::min(best + 1, kPlaces.size() - 1)];
  constexpr int kBits = 26;  // half of a double's: more is lost in rounding near a minimum
  const PsychometricPeak& near = peaks[best];
  const auto found = boost::math::tools::brent_find_minima(
      [&](double place) { return -peak_at(place, near).value; }, low, high, kBits);
  const PsychometricPeak peak = peak_at(found.first, near);
  return peak.value > near.value ? peak : near;
}

// A first centre and spread, from a coarse grid.
PsychometricPeak first_peak(const PsychometricLikelihood& likelihood) {
  constexpr int kCentres = 24, kSpreads = 12;
  const auto& x = likelihood.places();
  const auto& fixed = likelihood.options().threshold;
  const double range = x.back() - x.front();
  PsychometricPeak best;
  best.value = -INFINITY;
  for (int i = 0; i <= (fixed ? 0 : kCentres); ++i)
    for (int j = 0; j < kSpreads; ++j) {
      const double centre = fixed.value_or(x.front() + range * i / kCentres);
      PsychometricPeak at{centre, std::log(2 * range * std::pow(0.6, j)), 0, 0, 0};
      at.value = likelihood.at(likelihood.tails(at.centre, std::exp(at.log_spread)), 0.02, 0);
      if (at.value > best.value) best = at;
    }
  return best;
}

// One parameter: nodes between two ends that move until they enclose the posterior.
struct GridAxis {
  double low = 0, high = 0, least = 0, most = 0;
  std::vector<double> nodes, weights, density;

  bool fixed() const { return least == most; }
  double span() const { return high - low; }
};

void place_at_one(GridAxis& axis) {
  axis.nodes.assign(1, axis.low);
  axis.weights.assign(1, 1);
}

void place_evenly(GridAxis& axis, std::size_t count) {
  if (axis.fixed()) return place_at_one(axis);
  axis.nodes.clear();
  for (std::size_t i = 0; i < count; ++i)
    axis.nodes.push_back(axis.low + axis.span() * static_cast<double>(i) / static_cast<double>(count - 1));
  axis.weights.assign(count, axis.span() / static_cast<double>(count - 1));
  axis.weights.front() /= 2;
  axis.weights.back() /= 2;
}

// Gauss-Legendre nodes: the posteriors of lapse and eta do not fall to zero at 0.
template <unsigned kCount>
void place_by_gauss(GridAxis& axis) {
  using Rule = boost::math::quadrature::gauss<double, kCount>;
  if (axis.fixed()) return place_at_one(axis);
  axis.nodes.assign(kCount, axis.low);
  axis.weights.assign(kCount, 0);
  const auto& places = Rule::abscissa();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t up = kCount / 2 + i, down = kCount - 1 - up;
    axis.nodes[up] = axis.low + axis.span() * (1 + places[i]) / 2;
    axis.nodes[down] = axis.low + axis.span() * (1 - places[i]) / 2;
    axis.weights[up] = axis.weights[down] = axis.span() * Rule::weights()[i] / 2;
  }
}

double raised_cosine(double part) {
  return schema::falling_cosine(std::numbers::pi * std::clamp(part, -1.0, 1.0));
}

// The limits of lapse (less than half of what guessing leaves) and of eta.
double most_lapse(const PsychometricOptions& options) {
  return 0.8 * (options.guess ? 1 - *options.guess : 0.5);
}

class PosteriorGrid {
 public:
  PosteriorGrid(const PsychometricLikelihood& likelihood, const LevelRange& range,
                const PsychometricPeak& peak)
      : likelihood_(likelihood), range_(range), peak_(peak) {
    const PsychometricOptions& options = likelihood.options();
    width_ = standard_quantile(options.shape, 0.95) - standard_quantile(options.shape, 0.05);
    const double spread = std::exp(peak.log_spread), half = range.range() / 2;
    const auto& fixed = options.threshold;
    centre_ = fixed ? around(*fixed, 0, *fixed, *fixed)
                    : around(peak.centre, spread / 2, range.least - half, range.most + half);
    spread_ =
        around(peak.log_spread, 0.5, std::log(range.spacing / width_), std::log(3 * range.range() / width_));
    lapse_ = options.lapse ? around(*options.lapse, 0, *options.lapse, *options.lapse)
                           : around(peak.lapse, 0.05, 0, most_lapse(options));
    eta_ = around(peak.eta, 0.1, 0, options.overdispersed ? kMostEta : 0);
  }

  PosteriorIntervals intervals() {
    enclose();
    fill<41, 12>();
    return {{quantile(centre_, 0.025), quantile(centre_, 0.975)},
            {std::exp(quantile(spread_, 0.025)), std::exp(quantile(spread_, 0.975))},
            quantile(lapse_, 0.95),
            quantile(eta_, 0.95)};
  }

 private:
  static GridAxis around(double middle, double half, double least, double most) {
    const double inside = std::clamp(middle, least, most);
    GridAxis axis;
    axis.low = std::max(least, inside - half);
    axis.high = std::min(most, inside + half);
    axis.least = least;
    axis.most = most;
    return axis;
  }

  // The priors of threshold and width. In the flat part they are 1.
  double prior(double centre, double spread) const {
    const double range = range_.range(), width = width_ * spread;
    const double beyond = std::max({range_.least - centre, centre - range_.most, 0.0});
    const double narrow = std::max(0.0, 2 - width / range_.spacing), wide = std::max(0.0, width / range - 1);
    return raised_cosine(2 * beyond / range) * raised_cosine(narrow) * raised_cosine(wide / 2);
  }

  template <std::size_t kEven, unsigned kGauss>
  void fill() {
    place_evenly(centre_, kEven);
    place_evenly(spread_, kEven);
    place_by_gauss<kGauss>(lapse_);
    place_by_gauss<kGauss>(eta_);
    for (GridAxis* axis : axes()) axis->density.assign(axis->nodes.size(), 0);
    for (std::size_t i = 0; i < centre_.nodes.size(); ++i)
      for (std::size_t j = 0; j < spread_.nodes.size(); ++j) add_cell(i, j);
  }

  // All lapses and etas at one centre and spread. The density of log spread is that of spread times spread.
  void add_cell(std::size_t i, std::size_t j) {
    const double spread = std::exp(spread_.nodes[j]);
    const double weight = prior(centre_.nodes[i], spread) * spread * centre_.weights[i] * spread_.weights[j];
    if (!(weight > 0)) return;
    const auto tails = likelihood_.tails(centre_.nodes[i], spread);
    for (std::size_t k = 0; k < lapse_.nodes.size(); ++k)
      for (std::size_t l = 0; l < eta_.nodes.size(); ++l) {
        const double value = likelihood_.at(tails, lapse_.nodes[k], eta_.nodes[l]) - peak_.value;
        const double mass = weight * lapse_.weights[k] * eta_.weights[l] * std::exp(value);
        centre_.density[i] += mass / centre_.weights[i];
        spread_.density[j] += mass / spread_.weights[j];
        lapse_.density[k] += mass / lapse_.weights[k];
        eta_.density[l] += mass / eta_.weights[l];
      }
  }

  // Moves the ends until the density beyond them is below 1e-4 of the largest.
  void enclose() {
    constexpr int kMostRounds = 12;
    for (int round = 0; round < kMostRounds; ++round) {
      fill<17, 7>();
      bool moved = false;
      for (GridAxis* axis : axes()) moved = move_ends(*axis) || moved;
      if (!moved) return;
    }
  }

  static bool move_ends(GridAxis& axis) {
    if (axis.fixed()) return false;
    const double enough = 1e-4 * *std::ranges::max_element(axis.density);
    std::size_t first = 0, last = axis.density.size() - 1;
    while (first < last && axis.density[first] < enough) ++first;
    while (last > first && axis.density[last] < enough) --last;
    const double span = axis.span(), low = axis.low, high = axis.high;
    axis.low = std::max(axis.least, first == 0 ? low - span / 2 : axis.nodes[first - 1]);
    axis.high = std::min(axis.most, last + 1 == axis.nodes.size() ? high + span / 2 : axis.nodes[last + 1]);
    return std::max(std::abs(axis.low - low), std::abs(axis.high - high)) > 0.1 * span;
  }

  // By the sum of densities, which is linear between nodes.
  static double quantile(const GridAxis& axis, double part) {
    if (axis.fixed()) return axis.low;
    std::vector<double> places = {axis.low}, sums = {0};
    const auto add = [&](double place, double mass) {
      places.push_back(place);
      sums.push_back(sums.back() + mass);
    };
    for (std::size_t i = 0; i < axis.nodes.size(); ++i) {
      const double end = i + 1 == axis.nodes.size() ? axis.high : (axis.nodes[i] + axis.nodes[i + 1]) / 2;
      add(end, axis.density[i] * axis.weights[i]);
    }
    const double sum = part * sums.back();
    const auto above = static_cast<std::size_t>(std::ranges::lower_bound(sums, sum) - sums.begin());
    if (above == 0) return places.front();
    const double mass = sums[above] - sums[above - 1];
    return places[above - 1] +
           (places[above] - places[above - 1]) * (mass > 0 ? (sum - sums[above - 1]) / mass : 0);
  }

  std::array<GridAxis*, 4> axes() { return {&centre_, &spread_, &lapse_, &eta_}; }

  const PsychometricLikelihood& likelihood_;
  const LevelRange range_;
  const PsychometricPeak peak_;
  double width_ = 1;
  GridAxis centre_, spread_, lapse_, eta_;
};

PsychometricLikelihood::PsychometricLikelihood(std::span<const LevelCount> levels,
                                               const PsychometricOptions& options)
    : levels_(levels), options_(options) {
  for (const LevelCount& each : levels) scaled_.push_back(scaled_level(options.shape, each.level));
  places_ = scaled_;
  if (!options.threshold) return;
  for (const double level : scaled_) places_.push_back(2 * *options.threshold - level);
  std::ranges::sort(places_);
  places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
}

PsychometricLikelihood::Tails PsychometricLikelihood::tails(double centre, double spread) const {
  Tails tails(scaled_.size());
  for (std::size_t i = 0; i < tails.size(); ++i)
    tails[i] = standard_function(options_.shape, (scaled_[i] - centre) / spread);
  return tails;
}

double PsychometricLikelihood::at(const Tails& tails, double lapse, double eta) const {
  const double low = options_.guess.value_or(lapse), rise = 1 - low - lapse;
  const double counts = 1 / (eta * eta) - 1;
  double sum = options_.lapse ? 0 : (kLapsePrior - 1) * std::log1p(-lapse);
  if (options_.overdispersed) sum += (kEtaPrior - 1) * std::log1p(-eta);
  for (std::size_t i = 0; i < tails.size(); ++i) {
    const double p = low + rise * tails[i].first, q = lapse + rise * tails[i].second;
    const double yes = levels_[i].yes, no = levels_[i].trials - yes;
    sum += eta < kLeastEta ? times_log(yes, p) + times_log(no, q) : scattered(yes, no, p, q, counts);
  }
  return sum;
}

// Maximum over centre and spread by Newton's method, inside it over lapse and eta by Brent's.
PsychometricPeak peak_of(const PsychometricLikelihood& likelihood) {
  const PsychometricOptions& options = likelihood.options();
  const PsychometricPeak first = first_peak(likelihood);
  const auto at = [&](double lapse, double eta, const PsychometricPeak& from) {
    PsychometricPeak start = from.value == 0 ? first : from;
    start.lapse = lapse;
    start.eta = eta;
    return Climb(likelihood, start).top();
  };
  const auto over_lapse = [&](double eta, const PsychometricPeak& from) {
    if (options.lapse) return at(*options.lapse, eta, from);
    return best_peak(most_lapse(options), [&](double lapse, const PsychometricPeak& near) {
      return at(lapse, eta, near.value == 0 ? from : near);
    });
  };
  if (!options.overdispersed) return over_lapse(0, first);
  return best_peak(kMostEta, over_lapse);
}

// Integrates the posterior on a grid around its peak.
PosteriorIntervals posterior_intervals(const PsychometricLikelihood& likelihood, const LevelRange& range,
                                       const PsychometricPeak& peak) {
  return PosteriorGrid(likelihood, range, peak).intervals();
}

std::vector<LevelCount> merged(std::vector<LevelCount> levels) {
  std::ranges::sort(levels, {}, &LevelCount::level);
  std::vector<LevelCount> each;
  for (const LevelCount& one : levels) {
    if (each.empty() || each.back().level != one.level) each.push_back({one.level, 0, 0});
    each.back().yes += one.yes;
    each.back().trials += one.trials;
  }
  return each;
}

double total_of(const std::vector<LevelCount>& levels, double LevelCount::*member) {
  return std::accumulate(levels.begin(), levels.end(), 0.0,
                         [&](double sum, const LevelCount& each) { return sum + each.*member; });
}

// The covariance of level and answer, times the number of trials.
double rise_of(const std::vector<LevelCount>& levels) {
  const double trials = total_of(levels, &LevelCount::trials),
               share = total_of(levels, &LevelCount::yes) / trials;
  double sum = 0;
  for (const LevelCount& each : levels) sum += each.level * (each.yes - share * each.trials);
  return sum;
}

constexpr const char* kBoundOfJnd = "all answers but lapses are right: this bounds the JND only";
constexpr const char* kMeasureNear = "a bound is no estimate: measure at levels nearer to the standard";

// With a fixed threshold: the answers that are right, and whether they are more than half.
Result<void> check_right_answers(const std::vector<LevelCount>& levels, double threshold) {
  double right = 0, trials = 0;
  for (const LevelCount& each : levels) {
    if (each.level == threshold) continue;
    right += each.level > threshold ? each.yes : each.trials - each.yes;
    trials += each.trials;
  }
  if (right == trials) return fail(ErrorKind::unsuitable, kBoundOfJnd, {}, kMeasureNear);
  if (2 * right > trials) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("{:g} of {:g} answers are right, no more than by guessing", right, trials), {},
              "measure at levels farther from the standard");
}

Result<void> check_answers(const std::vector<LevelCount>& levels, const PsychometricOptions& options) {
  if (levels.size() < 2)
    return fail(ErrorKind::unsuitable, "all answers are at one level", {},
                "a function needs answers at two levels or more, better at six");
  if (options.shape == Shape::weibull && levels.front().level <= 0)
    return fail(ErrorKind::unsuitable, fmt::format("the level {:g} is not above 0", levels.front().level), {},
                "a Weibull function needs levels above 0: use --function normal");
  if (options.threshold) return check_right_answers(levels, *options.threshold);
  const double yes = total_of(levels, &LevelCount::yes), trials = total_of(levels, &LevelCount::trials);
  constexpr const char* kRemedy = "a bound is no estimate: measure at levels where both answers occur";
  if (yes == 0)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("all {:g} answers are 'no': the threshold is above {:g}", trials, levels.back().level),
        {}, kRemedy);
  if (yes == trials)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("all {:g} answers are 'yes': the threshold is below {:g}", trials, levels.front().level),
        {}, kRemedy);
  if (!(rise_of(levels) > 0))
    return fail(
        ErrorKind::unsuitable, "the answers don't become more frequent as the level rises", {},
        "check whether the two answers were exchanged (in a table: name the other column with --yes)");
  return {};
}

LevelRange range_of(const std::vector<double>& x) {
  LevelRange range{x.front(), x.back(), (x.back() - x.front()) / 4};
  for (std::size_t i = 1; i < x.size(); ++i) range.spacing = std::min(range.spacing, x[i] - x[i - 1]);
  return range;
}

double nearest_place(const PsychometricLikelihood& likelihood, double centre) {
  return *std::ranges::min_element(likelihood.places(), {}, [&](double x) { return std::abs(x - centre); });
}

// Whether a smaller spread fits as well: F is 0 or 1 at all levels, or at all but the nearest one, at which
// it stays the same.
bool is_step(const PsychometricLikelihood& likelihood, const PsychometricPeak& peak) {
  constexpr double kSmaller = 0.25, kRounding = 1e-9;
  const bool fixed = likelihood.options().threshold.has_value();
  const double centre =
      fixed ? peak.centre : std::lerp(nearest_place(likelihood, peak.centre), peak.centre, kSmaller);
  const auto tails = likelihood.tails(centre, kSmaller * std::exp(peak.log_spread));
  return likelihood.at(tails, peak.lapse, peak.eta) >= peak.value - kRounding;
}

// Precondition: a step, without a fixed threshold.
tl::unexpected<schema::Error> step_error(const std::vector<LevelCount>& levels,
                                         const PsychometricLikelihood& likelihood,
                                         const PsychometricPeak& peak) {
  constexpr double kNone = 1e-3;
  const Shape shape = likelihood.options().shape;
  const double nearest = nearest_place(likelihood, peak.centre);
  const auto [below, above] = standard_function(shape, (nearest - peak.centre) / std::exp(peak.log_spread));
  if (std::min(below, above) >= kNone)
    return fail(ErrorKind::unsuitable,
                fmt::format("both answers occur at {:g} only: this bounds the JND", level_of(shape, nearest)),
                {}, "a bound is no estimate: measure at levels near this one");
  auto next = std::ranges::upper_bound(levels, level_of(shape, peak.centre), {}, &LevelCount::level);
  next = std::clamp(next, levels.begin() + 1, levels.end() - 1);
  return fail(
      ErrorKind::unsuitable,
      fmt::format("the answers change at once between {:g} and {:g}: this bounds the threshold and the JND",
                  (next - 1)->level, next->level),
      {}, "a bound is no estimate: measure at levels between these two");
}

double width_of(const PsychometricOptions& options) {
  return standard_quantile(options.shape, 0.95) - standard_quantile(options.shape, 0.05);
}

// Answers that give only a bound: a step, or a peak outside the priors.
Result<void> check_peak(const std::vector<LevelCount>& levels, const PsychometricLikelihood& likelihood,
                        const LevelRange& range, const PsychometricPeak& peak) {
  const PsychometricOptions& options = likelihood.options();
  const double threshold = level_of(options.shape, peak.centre);
  if (is_step(likelihood, peak)) {
    if (options.threshold) return fail(ErrorKind::unsuitable, kBoundOfJnd, {}, kMeasureNear);
    return step_error(levels, likelihood, peak);
  }
  if (width_of(options) * std::exp(peak.log_spread) > 3 * range.range())
    return fail(ErrorKind::unsuitable, "the answers depend too little on the level to estimate a threshold",
                {}, "measure over a wider range of levels, or more often");
  if (const double half = range.range() / 2;
      peak.centre < range.least - half || peak.centre > range.most + half)
    return fail(ErrorKind::unsuitable,
                fmt::format("the threshold is far outside the measured levels, near {:.3g}", threshold), {},
                "measure at levels around it");
  return {};
}

void judge_fit(PsychometricFit& fit, const PsychometricOptions& options) {
  for (const LevelCount& each : fit.levels) {
    const double p = fit.function(each.level), no = each.trials - each.yes;
    fit.deviance += deviance_part(each.yes, each.trials, p) + deviance_part(no, each.trials, 1 - p);
  }
  const std::size_t parameters = (options.threshold ? 1U : 2U) + (options.lapse ? 0U : 1U);
  fit.freedom = fit.levels.size() - std::min(fit.levels.size(), parameters);
  fit.p = chi_squared_p(fit.deviance, fit.freedom);
}

void note_limits(PsychometricFit& fit, const PsychometricOptions& options, const LevelRange& range,
                 const PosteriorIntervals& intervals) {
  const double width = width_of(options);
  const std::string name = options.shape == Shape::weibull ? "exponent" : options.guess ? "width" : "JND";
  if (intervals.centre.low < range.least || intervals.centre.high > range.most)
    fit.notes.push_back(
        "the interval of the threshold reaches beyond the measured levels: measure further out");
  if (width * intervals.spread.high > 1.5 * range.range())
    fit.notes.push_back(fmt::format(
        "the interval of the {} is limited by the range of the levels: measure further out", name));
  if (width * intervals.spread.low < 1.5 * range.spacing)
    fit.notes.push_back(fmt::format(
        "the interval of the {} is limited by the distance between levels: measure between them", name));
}

}  // namespace

Result<PsychometricFunction> most_probable_function(std::vector<LevelCount> counts,
                                                    const PsychometricOptions& options) {
  const std::vector<LevelCount> levels = merged(std::move(counts));
  TACTO_TRY(check_answers(levels, options));
  const PsychometricLikelihood likelihood(levels, options);
  const PsychometricPeak peak = peak_of(likelihood);
  TACTO_TRY(check_peak(levels, likelihood, range_of(likelihood.places()), peak));
  return PsychometricFunction{options.shape, peak.centre, std::exp(peak.log_spread), peak.lapse,
                              options.guess};
}

Result<PsychometricFit> fit_psychometric(std::vector<LevelCount> counts, const PsychometricOptions& options) {
  PsychometricFit fit;
  fit.levels = merged(std::move(counts));
  TACTO_TRY(check_answers(fit.levels, options));
  const PsychometricLikelihood likelihood(fit.levels, options);
  const LevelRange range = range_of(likelihood.places());
  const PsychometricPeak peak = peak_of(likelihood);
  const double spread = std::exp(peak.log_spread);
  TACTO_TRY(check_peak(fit.levels, likelihood, range, peak));
  const PosteriorIntervals intervals = posterior_intervals(likelihood, range, peak);
  fit.function = {options.shape, peak.centre, spread, peak.lapse, options.guess};
  fit.threshold = {level_of(options.shape, peak.centre), level_of(options.shape, intervals.centre.low),
                   level_of(options.shape, intervals.centre.high)};
  fit.spread = {spread, intervals.spread.low, intervals.spread.high};
  fit.lapse_high = intervals.lapse_high;
  fit.overdispersion = peak.eta;
  fit.overdispersion_high = intervals.eta_high;
  judge_fit(fit, options);
  note_limits(fit, options, range, intervals);
  return fit;
}

}  // namespace tacto::analysis

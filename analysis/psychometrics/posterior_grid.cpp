// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/posterior_grid.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "data-schema/base/raised_cosine.hpp"

namespace tacto::analysis {
namespace {

// One parameter: nodes between two ends that move until they enclose the posterior.
struct GridAxis {
  double low = 0, high = 0, least = 0, most = 0;
  std::vector<double> nodes, weights, density;

  bool fixed() const { return least == most; }
  double span() const { return high - low; }
};

void place_evenly(GridAxis& axis, std::size_t count) {
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
  axis.nodes.assign(kCount, axis.low);
  axis.weights.assign(kCount, 0);
  axis.weights.front() = 1;
  if (axis.fixed()) {
    axis.nodes.resize(1);
    axis.weights.resize(1);
    return;
  }
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

class PosteriorGrid {
 public:
  PosteriorGrid(const PsychometricLikelihood& likelihood, const LevelRange& range,
                const PsychometricPeak& peak)
      : likelihood_(likelihood), range_(range), peak_(peak) {
    const PsychometricOptions& options = likelihood.options();
    width_ = standard_quantile(options.shape, 0.95) - standard_quantile(options.shape, 0.05);
    const double spread = std::exp(peak.log_spread), half = range.range() / 2;
    centre_ = around(peak.centre, spread / 2, range.least - half, range.most + half);
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

}  // namespace

PosteriorIntervals posterior_intervals(const PsychometricLikelihood& likelihood, const LevelRange& range,
                                       const PsychometricPeak& peak) {
  return PosteriorGrid(likelihood, range, peak).intervals();
}

}  // namespace tacto::analysis

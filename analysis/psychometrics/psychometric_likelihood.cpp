// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/psychometric_likelihood.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>

namespace tacto::analysis {
namespace {

// Beta(1, b): density b (1 - x)^(b - 1). Lapses: mean 5 %; overdispersion: as Schuett 2016.
constexpr double kLapsePrior = 19, kEtaPrior = 10;
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
    const auto f = [&](double x, double y) {
      return value(at_.centre + unit * kStep * x, at_.log_spread + kStep * y);
    };
    const double left = f(-1, 0), right = f(1, 0), below = f(0, -1), above = f(0, 1), here = at_.value;
    const Eigen::Vector2d slope((right - left) / 2, (above - below) / 2);
    const double mixed = (f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / 4;
    Eigen::Matrix2d bend;
    bend << left - 2 * here + right, mixed, mixed, below - 2 * here + above;
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
  const auto& x = likelihood.scaled_levels();
  const double range = x.back() - x.front();
  PsychometricPeak best;
  best.value = -INFINITY;
  for (int i = 0; i <= kCentres; ++i)
    for (int j = 0; j < kSpreads; ++j) {
      PsychometricPeak at{x.front() + range * i / kCentres, std::log(2 * range * std::pow(0.6, j)), 0, 0, 0};
      at.value = likelihood.at(likelihood.tails(at.centre, std::exp(at.log_spread)), 0.02, 0);
      if (at.value > best.value) best = at;
    }
  return best;
}

}  // namespace

PsychometricLikelihood::PsychometricLikelihood(std::span<const LevelCount> levels,
                                               const PsychometricOptions& options)
    : levels_(levels), options_(options) {
  for (const LevelCount& each : levels) scaled_.push_back(scaled_level(options.shape, each.level));
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

double most_lapse(const PsychometricOptions& options) {
  return 0.8 * (options.guess ? 1 - *options.guess : 0.5);
}

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

}  // namespace tacto::analysis

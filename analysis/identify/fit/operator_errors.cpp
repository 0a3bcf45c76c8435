// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/operator_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/identify/fit/least_squares.hpp"
#include "playback/model/hysteresis_inverse.hpp"

namespace tacto::analysis {
namespace {

constexpr double kMisfitQuantile = 3.29;  // of the normal distribution; 5 in 10,000 exceed it
// Factor on the error of independent play operators: those of one bender have similar weights, so that their
// errors add up.
constexpr double kCoherent = 2;

double mean_square(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.0) / static_cast<double>(x.size());
}

double mean_square_of_neighbours(std::span<const double> x) {
  double sum = 0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += (x[i] - x[i - 1]) * (x[i] - x[i - 1]);
  return sum / (2 * static_cast<double>(x.size() - 1));
}

std::vector<double> column_of(const FittedOperator& fitted, double threshold_v) {
  const auto play = playback::played_through({{threshold_v}, {1}}, fitted.drive_v);
  return {play.begin() + static_cast<std::ptrdiff_t>(fitted.first), play.end()};
}

// The play operators with a weight in the fit, and one in the middle of each two thresholds.
struct Plays {
  std::vector<double> thresholds_v;  // those with a weight, then those in the middle
  std::size_t own = 0;
  std::vector<double> usual_weights;  // of those in the middle: mean weight per volt, times the spacing

  explicit Plays(const schema::Hysteresis& found) {
    const auto& r = found.thresholds_v;
    for (std::size_t i = 0; i < r.size(); ++i)
      if (found.weights[i] > 0) thresholds_v.push_back(r[i]);
    own = thresholds_v.size();
    // The first weight has the threshold 0, which is no play operator.
    const double a_volt = std::accumulate(found.weights.begin() + 1, found.weights.end(), 0.0) / r.back();
    for (std::size_t i = 1; i < r.size(); ++i) {
      thresholds_v.push_back(std::midpoint(r[i - 1], r[i]));
      usual_weights.push_back(a_volt * (r[i] - r[i - 1]));
    }
  }
  schema::Hysteresis change(std::span<const double> of_own, double times) const {
    schema::Hysteresis change{thresholds_v, std::vector<double>(thresholds_v.size(), 0.0)};
    for (std::size_t i = 0; i < own; ++i) change.weights[i] = times * of_own[i];
    return change;
  }
};

ColumnErrors errors_of(const FittedOperator& fitted, const Plays& play_operators) {
  std::vector<std::vector<double>> own, between;
  for (std::size_t i = 0; i < play_operators.thresholds_v.size(); ++i)
    (i < play_operators.own ? own : between).push_back(column_of(fitted, play_operators.thresholds_v[i]));
  own.emplace_back(fitted.left.size(), 1.0);  // the offset
  return column_errors(own, between);
}

void add_misfit(const ColumnErrors& found, const Plays& play_operators, double misfit_squares,
                OperatorErrors& errors) {
  double explained = 0;
  for (std::size_t i = 0; i < found.left.size(); ++i)
    explained += play_operators.usual_weights[i] * play_operators.usual_weights[i] * found.left[i];
  if (!(explained > 0)) return;
  const double times = kCoherent * std::sqrt(misfit_squares / explained);
  for (std::size_t i = 0; i < found.left.size(); ++i) {
    const double weight = times * play_operators.usual_weights[i];
    schema::Hysteresis change = play_operators.change(found.taken[i], -weight);
    change.weights[play_operators.own + i] = weight;
    errors.by_misfit.push_back(std::move(change));
  }
}

}  // namespace

OperatorErrors operator_errors(const FittedOperator& fitted) {
  OperatorErrors errors;
  const auto samples = static_cast<double>(fitted.left.size());
  const double all = mean_square(fitted.left), noise = mean_square_of_neighbours(fitted.left);
  const bool misfit = all - noise > kMisfitQuantile * noise / std::sqrt(samples);
  errors.noise = std::sqrt(misfit ? noise : all);
  errors.misfit = misfit ? std::sqrt(all - noise) : 0;
  const Plays play_operators(fitted.found);
  const ColumnErrors found = errors_of(fitted, play_operators);
  for (const auto& direction : found.noise)
    errors.by_noise.push_back(play_operators.change(direction, errors.noise));
  if (misfit) add_misfit(found, play_operators, samples * (all - noise), errors);
  return errors;
}

}  // namespace tacto::analysis

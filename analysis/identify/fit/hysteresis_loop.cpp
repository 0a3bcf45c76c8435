// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/hysteresis_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "analysis/identify/fit/least_squares.hpp"
#include "analysis/identify/fit/misfit.hpp"
#include "data-schema/base/statistics.hpp"
#include "playback/model/hysteresis_inverse.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

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

constexpr std::size_t kFewestLoopSamples = 100;
constexpr double kNearZero = 0.1;    // of the amplitude; within it a branch is assumed to be straight
constexpr double kFullSwing = 0.98;  // of the amplitude; a loop with this swing counts as largest
constexpr double kSmallResidual = 0.01;
constexpr std::size_t kFineThresholds = 8;

std::vector<double> delayed(std::span<const double> v, double samples) {
  std::vector<double> out(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double at = std::max(0.0, static_cast<double>(i) - samples);
    const auto before = std::min(static_cast<std::size_t>(at), v.size() - 1);
    const std::size_t after = std::min(before + 1, v.size() - 1);
    out[i] = std::lerp(v[before], v[after], at - static_cast<double>(before));
  }
  return out;
}

std::vector<double> centred(std::span<const double> x) {
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  std::vector<double> out(x.begin(), x.end());
  for (double& value : out) value -= mean;
  return out;
}

// The last part with a full swing between two upward zero crossings of the drive.
struct LoopStretch {
  std::size_t first = 0, end = 0;
};

LoopStretch largest_loop(std::span<const double> v, double amplitude_v) {
  std::vector<std::size_t> upward;
  for (std::size_t i = 1; i < v.size(); ++i)
    if (v[i - 1] < 0 && v[i] >= 0) upward.push_back(i);
  for (std::size_t n = upward.size(); n-- > 1;) {
    const auto part = v.subspan(upward[n - 1], upward[n] - upward[n - 1]);
    const auto [low, high] = std::ranges::minmax(part);
    if (high > kFullSwing * amplitude_v && -low > kFullSwing * amplitude_v) return {upward[n - 1], upward[n]};
  }
  return {};
}

// Displacement of the branch of this direction at zero drive, by a straight line through the values near
// zero.
double branch_at_zero(std::span<const double> v, std::span<const double> x, double amplitude_v,
                      int direction) {
  double n = 0, sv = 0, sx = 0, svv = 0, svx = 0;
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (std::abs(v[i]) > kNearZero * amplitude_v || (v[i] - v[i - 1]) * direction <= 0) continue;
    ++n, sv += v[i], sx += x[i], svv += v[i] * v[i], svx += v[i] * x[i];
  }
  const double slope = (n * svx - sv * sx) / (n * svv - sv * sv);
  return n < 3 ? std::nan("") : (sx - slope * sv) / n;
}

std::complex<double> fundamental(std::span<const double> x) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += x[i] *
           std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(x.size()));
  return sum;
}

void put_loop(std::span<const double> v, std::span<const double> x, LoopStretch loop, LoopFit& fit) {
  const auto lv = v.subspan(loop.first, loop.end - loop.first),
             lx = x.subspan(loop.first, loop.end - loop.first);
  fit.loop_v.assign(lv.begin(), lv.end());
  fit.loop_m.assign(lx.begin(), lx.end());
  const auto [low, high] = std::ranges::minmax(lx);
  const double up = branch_at_zero(lv, lx, fit.amplitude_v, 1),
               down = branch_at_zero(lv, lx, fit.amplitude_v, -1);
  fit.opening = std::abs(down - up) / (high - low);
  fit.ellipse_lag_rad = std::asin(std::min(1.0, fit.opening));
  fit.lag_rad = std::arg(fundamental(lv) / fundamental(lx));
}

// Scales the weights of the non-negative fit and computes the gain. The first weight is at least a thousandth
// of the sum, so that the operator has an inverse.
void put_operator(const std::vector<double>& thresholds_v, std::vector<double> weights, double limit_v,
                  LoopFit& fit) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  weights[0] = std::max(weights[0], 1e-3 * sum);
  double at_limit = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    at_limit += weights[i] * std::max(0.0, limit_v - thresholds_v[i]);
  fit.gain_m_per_v = at_limit / limit_v;
  for (double& weight : weights) weight *= limit_v / at_limit;
  fit.hysteresis = {thresholds_v, std::move(weights)};
}

Result<void> check_loops(std::span<const double> v, std::span<const double> x) {
  if (v.size() < kFewestLoopSamples || v.size() != x.size())
    return fail(ErrorKind::unsuitable, fmt::format("{} samples are too few for a loop", v.size()), "loop");
  for (std::size_t i = 0; i < v.size(); ++i)
    if (!std::isfinite(v[i]) || !std::isfinite(x[i]))
      return fail(ErrorKind::unsuitable, "a value is not a number", fmt::format("loop, sample {}", i + 1));
  return {};
}

// The noise is half the mean square of neighbours' differences (von Neumann 1941). The residual beyond it is
// a misfit, if white noise would cause it in at most 5 of 10,000 cases. Noise: the covariance of the
// weights. Misfit: play operators that the operator lacks, one in the middle of each two of its thresholds,
// with weights like its own, scaled to explain the misfit. Each changes the operator independently, minus
// the part that the fit would absorb.
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

}  // namespace

namespace {

std::vector<double> even_thresholds(std::size_t count, double amplitude_v) {
  std::vector<double> list;
  for (std::size_t i = 0; i < count; ++i)
    list.push_back(amplitude_v * static_cast<double>(i) / static_cast<double>(count));
  return list;
}

}  // namespace

std::vector<double> thresholds_finer_below(double fine_v, double amplitude_v) {
  if (fine_v > amplitude_v / 2) return even_thresholds(2 * kFineThresholds + 1, amplitude_v);
  std::vector<double> list = even_thresholds(kFineThresholds, fine_v);
  for (std::size_t i = 0; i <= kFineThresholds; ++i)
    list.push_back(fine_v + (amplitude_v - fine_v) * static_cast<double>(i) / (kFineThresholds + 1));
  return list;
}

double delay_at_rest_s(const schema::Transducer& t) {
  return 2 * t.amplifier_resistance_ohm * t.capacitance_f +
         t.damping_n_s_per_m / (t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m);
}

namespace {

// The columns of the non-negative fit: play operators of the drive and a constant, from the first full swing
// on.
struct LoopTable {
  std::vector<double> thresholds_v;
  std::vector<std::vector<double>> columns;
  std::vector<double> answer;
  double sign = 1;  // of the displacement for a positive drive
};

// The state of the play operators is known only after a full swing.
std::ptrdiff_t first_known(std::span<const double> v, double amplitude_v) {
  return std::ranges::find_if(v, [&](double value) { return -value > kFullSwing * amplitude_v; }) - v.begin();
}

LoopTable loop_table(std::span<const double> v, std::span<const double> x, double amplitude_v,
                     std::vector<double> thresholds_v) {
  LoopTable table;
  const std::ptrdiff_t from = first_known(v, amplitude_v);
  table.thresholds_v = std::move(thresholds_v);
  for (const double threshold_v : table.thresholds_v) {
    const auto play = playback::played_through({{threshold_v}, {1}}, v);
    table.columns.emplace_back(play.begin() + from, play.end());
  }
  table.answer.assign(x.begin() + from, x.end());
  table.columns.emplace_back(table.answer.size(), 1.0);
  const auto& drive = table.columns.front();
  const std::vector<double> about_mean = centred(table.answer);
  if (std::inner_product(drive.begin(), drive.end(), about_mean.begin(), 0.0) < 0) table.sign = -1;
  for (double& value : table.answer) value *= table.sign;
  return table;
}

// The fitted operator's response in the largest loop, with the displacement's own sign; the last weight is
// the offset.
void put_loop_model(const LoopTable& table, std::span<const double> v, LoopStretch loop,
                    std::span<const double> weights, LoopFit& fit) {
  schema::Hysteresis made{table.thresholds_v, {weights.begin(), weights.end() - 1}};
  const auto whole = playback::played_through(made, v);
  for (std::size_t i = loop.first; i < loop.end; ++i)
    fit.loop_model_m.push_back(table.sign * (whole[i] + weights.back()));
}

std::vector<double> left_of(const LoopTable& table, std::span<const std::size_t> which,
                            std::span<const double> weights) {
  std::vector<double> rest = table.answer;
  for (std::size_t i = 0; i < which.size(); ++i)
    for (std::size_t n = 0; n < rest.size(); ++n) rest[n] -= weights[i] * table.columns[which[i]][n];
  return rest;
}

double squares_of(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
}

// Change of the scaled operator for a change of the fitted one, with the scaling of put_operator().
schema::Hysteresis scaled_change(const schema::Hysteresis& found, schema::Hysteresis change, double limit_v) {
  const auto at_limit = [&](const schema::Hysteresis& of) {
    double sum = 0;
    for (std::size_t i = 0; i < of.weights.size(); ++i)
      sum += of.weights[i] * std::max(0.0, limit_v - of.thresholds_v[i]);
    return sum;
  };
  const double whole = at_limit(found), changed = at_limit(change) / whole;
  for (std::size_t i = 0; i < found.weights.size(); ++i) {
    change.thresholds_v.push_back(found.thresholds_v[i]);
    change.weights.push_back(-changed * found.weights[i]);
  }
  for (double& weight : change.weights) weight *= limit_v / whole;
  return change;
}

void put_errors(const LoopTable& table, std::span<const double> v, std::span<const double> weights,
                std::span<const double> left, double limit_v, LoopFit& fit) {
  const schema::Hysteresis found{table.thresholds_v, {weights.begin(), weights.end() - 1}};
  fit.errors = operator_errors({v, v.size() - left.size(), found, left});
  for (auto* changes : {&fit.errors.by_noise, &fit.errors.by_misfit})
    for (schema::Hysteresis& change : *changes) change = scaled_change(found, std::move(change), limit_v);
  const double size = schema::rms_of(centred(table.answer));
  fit.errors.noise /= size;
  fit.errors.misfit /= size;
}

void put_quality(const LoopTable& table, std::span<const double> v, std::span<const double> weights,
                 double limit_v, LoopFit& fit) {
  std::vector<std::size_t> all(table.columns.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::size_t line[] = {0, table.columns.size() - 1};
  const auto straight =
      non_negative_least_squares({table.columns.front(), table.columns.back()}, table.answer, 1);
  const double size = schema::rms_of(centred(table.answer));
  const std::vector<double> left = left_of(table, all, weights),
                            left_by_line = left_of(table, line, straight);
  fit.residual_part = schema::rms_of(left) / size;
  fit.linear_residual_part = schema::rms_of(left_by_line) / size;
  fit.r_squared = 1 - fit.residual_part * fit.residual_part;
  put_errors(table, v, weights, left, limit_v, fit);
  const auto play_operators = static_cast<double>(table.thresholds_v.size() - 1);
  fit.explains_more =
      squares_of(left_by_line) - squares_of(left) >
      std::pow(fit.errors.noise * size, 2) * play_operators * highest_chi_squared(play_operators);
  // White noise of the sensor is no fault of the operator.
  fit.usable = fit.errors.misfit < kSmallResidual || fit.residual_part < fit.linear_residual_part / 3;
}

}  // namespace

Result<LoopFit> fit_loops(std::span<const double> drive_v, std::span<const double> displacement_m,
                          double rate_hz, double delay_s, double drive_limit_v,
                          std::vector<double> thresholds_v) {
  TACTO_TRY(check_loops(drive_v, displacement_m));
  const std::vector<double> v = delayed(drive_v, delay_s * rate_hz);
  LoopFit fit;
  fit.amplitude_v = std::abs(*std::ranges::max_element(v, {}, [](double value) { return std::abs(value); }));
  const LoopStretch loop = largest_loop(v, fit.amplitude_v);
  if (loop.end <= loop.first)
    return fail(ErrorKind::unsuitable,
                "the drive has no complete loop between its largest positive and negative values", "loop",
                "drive it slowly with a sine or a triangle about 0, two periods at the largest swing first");
  if (thresholds_v.empty()) thresholds_v = even_thresholds(kThresholds, fit.amplitude_v);
  const LoopTable table = loop_table(v, displacement_m, fit.amplitude_v, std::move(thresholds_v));
  std::vector<double> weights = non_negative_least_squares(table.columns, table.answer, 1);
  put_quality(table, v, weights, drive_limit_v, fit);
  put_loop_model(table, v, loop, weights, fit);
  weights.pop_back();
  put_operator(table.thresholds_v, std::move(weights), drive_limit_v, fit);
  fit.gain_m_per_v *= table.sign;
  put_loop(v, displacement_m, loop, fit);
  if (!std::isfinite(fit.opening))
    return fail(ErrorKind::unsuitable,
                "the drive passes zero too fast: fewer than three samples of a branch there", "loop",
                "drive it slowly: 1 Hz");
  fit.loop_hz = rate_hz / static_cast<double>(loop.end - loop.first);
  return fit;
}

}  // namespace tacto::analysis

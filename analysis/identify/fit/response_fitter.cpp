// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/response_fitter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identify/fit/student.hpp"

namespace tacto::analysis {
namespace {

constexpr double kVague = 1;      // standard error of a logarithm: a factor e
constexpr double kNowhere = 0.5;  // of a pole's range

}  // namespace

ResponseFitter::ResponseFitter(const BodeData& data, const ResponseModel& model, std::vector<double> start)
    : data_(data), model_(model), shared_(data), values_(std::move(start)), held_(values_.size(), false) {}

void ResponseFitter::run() {
  solve();
  for (std::size_t vague = vaguest(); vague < values_.size(); vague = vaguest()) {
    held_[vague] = true;
    values_[vague] = model_.parameters()[vague].base;
    solve();
  }
}

void ResponseFitter::take_uneven_noise() {
  RobustErrors errors = robust_errors([&](auto c, auto r) { residuals(c, r); }, 2 * data_.size(), solution_);
  solution_.covariance = std::move(errors.covariance);
  uneven_freedom_ = errors.freedom;
}

std::size_t ResponseFitter::free_count() const {
  return static_cast<std::size_t>(std::count(held_.begin(), held_.end(), false));
}

double ResponseFitter::freedom() const {
  return 2 * static_cast<double>(data_.size()) - static_cast<double>(free_count());
}

double ResponseFitter::variance() const {  // of the whitened residuals
  return data_.noise_is_measured() || uneven_freedom_ > 0 ? 1 : solution_.squares / freedom();
}

double ResponseFitter::standard_error(std::size_t i) const {
  const std::size_t at = place(i), n = free_count();
  return std::sqrt(variance() * solution_.covariance[at * n + at]);
}

// By the gradient of the model's logarithm.
double ResponseFitter::spread(double hz) const {
  const std::size_t n = free_count();
  const std::vector<double> slope = log_gradient(hz);
  double sum = 0;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) sum += slope[a] * solution_.covariance[a * n + b] * slope[b];
  return std::sqrt(std::max(0.0, variance() * sum));
}

double ResponseFitter::times_95() const {
  if (uneven_freedom_ > 0) return student_95(uneven_freedom_);
  if (!data_.noise_is_measured()) return student_95(freedom());
  return data_.noise_freedom > 0 ? student_95(data_.noise_freedom) : kNormal95;
}

std::string ResponseFitter::ended() const {
  if (!solution_.at_bound) return solution_.ended;
  std::size_t which = 0;
  for (std::size_t free = *solution_.at_bound; held_[which] || free > 0; ++which)
    if (!held_[which]) --free;
  const ModelParameter& p = model_.parameters()[which];
  return fmt::format("{} ran to the end of its range, {:.3g}: this model is not what was measured", p.name,
                     values_[which]);
}

std::size_t ResponseFitter::place(std::size_t parameter) const {
  return static_cast<std::size_t>(
      std::count(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(parameter), false));
}

std::vector<double> ResponseFitter::values_at(std::span<const double> coordinates) const {
  std::vector<double> values = values_;
  for (std::size_t i = 0, at = 0; i < values.size(); ++i)
    if (!held_[i]) values[i] = model_.parameters()[i].value(coordinates[at++]);
  return values;
}

void ResponseFitter::residuals(std::span<const double> coordinates, std::span<double> out) const {
  const std::vector<double> values = values_at(coordinates);
  for (std::size_t i = 0; i < data_.size(); ++i) {
    const auto r = (data_.response[i] - model_.at(values, data_.frequency_hz[i])) / sigma_at(data_, i);
    out[2 * i] = r.real();
    out[2 * i + 1] = r.imag();
  }
  shared_.take_from(out);
}

void ResponseFitter::solve() {
  std::vector<double> start;
  Bounds bounds;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (held_[i]) continue;
    const ModelParameter& p = model_.parameters()[i];
    start.push_back(p.coordinate(values_[i]));
    bounds.low.push_back(p.coordinate(p.low));
    bounds.high.push_back(p.coordinate(p.high));
  }
  solution_ = least_squares([&](auto c, auto r) { residuals(c, r); }, 2 * data_.size(), start, bounds);
  values_ = values_at(solution_.coordinates);
}

// The free parameter that the data say least of, where that is too little; else the number of parameters.
std::size_t ResponseFitter::vaguest() const {
  std::size_t worst = values_.size();
  double most = kVague;
  if (pole_is_nowhere()) return kPole;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (held_[i] || i == kGain || !model_.parameters()[i].logarithmic) continue;
    if (const double error = standard_error(i); error > most) worst = i, most = error;
  }
  return worst;
}

// At the end of its range: far beyond the band, where it does nothing.
bool ResponseFitter::pole_is_nowhere() const {
  if (model_.choice().finger || held_[kPole]) return false;
  const ModelParameter& pole = model_.parameters()[kPole];
  return values_[kPole] > kNowhere * pole.high || values_[kPole] < pole.low / kNowhere;
}

std::vector<double> ResponseFitter::log_gradient(double hz) const {
  constexpr double kStep = 1e-5;
  std::vector<double> slope, c = solution_.coordinates;
  for (double& coordinate : c) {
    const double middle = coordinate;
    coordinate = middle + kStep;
    const double ahead = std::log(std::abs(model_.at(values_at(c), hz)));
    coordinate = middle - kStep;
    slope.push_back((ahead - std::log(std::abs(model_.at(values_at(c), hz)))) / (2 * kStep));
    coordinate = middle;
  }
  return slope;
}

}  // namespace tacto::analysis

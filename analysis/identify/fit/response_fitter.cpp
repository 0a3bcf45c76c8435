// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/response_fitter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

constexpr double kVague = 1;      // standard error of a logarithm: a factor e
constexpr double kNowhere = 0.5;  // of a pole's range

}  // namespace

// Divided by how the data would change with the pole: so their noise stays what it is.
std::vector<std::complex<double>> modelled_by(const ResponseModel& model, const BodeData& data,
                                              std::span<const double> values) {
  std::vector<std::complex<double>> list;
  list.reserve(data.size());
  for (const double hz : data.frequency_hz) list.push_back(model.at(values, hz));
  if (!data.by_pole || model.choice().finger) return list;
  for (std::size_t i = 0; i < list.size(); ++i) list[i] /= data.by_pole->factor(i, values[kPole]);
  return list;
}

ResponseFitter::ResponseFitter(const BodeData& data, const ResponseModel& model, std::vector<double> start)
    : data_(data), model_(model), shared_(data), values_(std::move(start)), held_(values_.size(), false) {}

void ResponseFitter::run() {
  solve();
  for (std::size_t vague = least_determined(); vague < values_.size(); vague = least_determined()) {
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

// By the gradient of the model's logarithm (delta method).
double ResponseFitter::spread(double hz) const {
  const std::size_t n = free_count();
  const std::vector<double> slope = log_gradient(hz);
  double sum = 0;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) sum += slope[a] * solution_.covariance[a * n + b] * slope[b];
  return std::sqrt(std::max(0.0, variance() * sum));
}

double ResponseFitter::times_95() const {
  if (uneven_freedom_ > 0) return schema::student_t(uneven_freedom_, schema::kTwoSided95);
  if (!data_.noise_is_measured()) return schema::student_t(freedom(), schema::kTwoSided95);
  return schema::student_t(data_.noise_freedom > 0 ? data_.noise_freedom : INFINITY, schema::kTwoSided95);
}

std::string ResponseFitter::ended() const {
  if (!solution_.at_bound) return solution_.ended;
  std::size_t which = 0;
  for (std::size_t free = *solution_.at_bound; held_[which] || free > 0; ++which)
    if (!held_[which]) --free;
  const ModelParameter& p = model_.parameters()[which];
  return fmt::format("{} reached the end of its range, {:.3g}: the model does not describe the measurement",
                     p.name, values_[which]);
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
  const std::vector<std::complex<double>> model = modelled_by(model_, data_, values_at(coordinates));
  for (std::size_t i = 0; i < data_.size(); ++i) {
    const auto r = (data_.response[i] - model[i]) / sigma_at(data_, i);
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

// The least determined free parameter, if its error is above the limit; otherwise the number of parameters.
std::size_t ResponseFitter::least_determined() const {
  std::size_t worst = values_.size();
  double most = kVague;
  if (pole_out_of_band()) return kPole;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (held_[i] || i == kGain || !model_.parameters()[i].logarithmic) continue;
    if (const double error = standard_error(i); error > most) worst = i, most = error;
  }
  return worst;
}

// Whether the pole is at the end of its range, so far beyond the band that it has no effect.
bool ResponseFitter::pole_out_of_band() const {
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

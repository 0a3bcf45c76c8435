// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/response_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "analysis/identify/angles.hpp"
#include "analysis/identify/hold.hpp"
#include "analysis/identify/least_squares.hpp"
#include "analysis/identify/outlier.hpp"
#include "analysis/identify/starting_values.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;

constexpr int kCurvePoints = 101;
constexpr double kNormal95 = 1.959964;
constexpr double kVague = 1;         // standard error of a logarithm: a factor e
constexpr double kNowhere = 0.5;     // of a pole's range
constexpr double kExplains = 0.5;    // of what a misfit leaves
constexpr double kApart = 0.05;      // of two resonances that are two
constexpr double kNonlinear = 5e-3;  // third harmonic: above what a 16-bit converter makes of itself

// One fit: the model, its data, and which parameters are free.
class Fitter {
 public:
  Fitter(const BodeData& data, const ResponseModel& model, std::vector<double> start)
      : data_(data), model_(model), values_(std::move(start)), held_(values_.size(), false) {}

  void run() {
    solve();
    for (std::size_t vague = vaguest(); vague < values_.size(); vague = vaguest()) {
      held_[vague] = true;
      values_[vague] = model_.parameters()[vague].base;
      solve();
    }
  }
  std::size_t free_count() const {
    return static_cast<std::size_t>(std::count(held_.begin(), held_.end(), false));
  }
  double variance() const {  // of the whitened residuals
    const double freedom = 2 * static_cast<double>(data_.size()) - static_cast<double>(free_count());
    return data_.has_noise() ? 1 : solution_.squares / freedom;
  }
  double standard_error(std::size_t i) const {
    const std::size_t at = place(i), n = free_count();
    return std::sqrt(variance() * solution_.covariance[at * n + at]);
  }
  /// Relative standard error of |model| at a frequency: by the gradient of its logarithm.
  double spread(double hz) const {
    const std::size_t n = free_count();
    const std::vector<double> slope = log_gradient(hz);
    double sum = 0;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) sum += slope[a] * solution_.covariance[a * n + b] * slope[b];
    return std::sqrt(std::max(0.0, variance() * sum));
  }
  bool held(std::size_t i) const { return held_[i]; }
  std::string ended() const {
    if (!solution_.at_bound) return solution_.ended;
    std::size_t which = 0;
    for (std::size_t free = *solution_.at_bound; held_[which] || free > 0; ++which)
      if (!held_[which]) --free;
    const ModelParameter& p = model_.parameters()[which];
    return fmt::format("{} ran to the end of its range, {:.3g}: this model is not what was measured", p.name,
                       values_[which]);
  }
  const std::vector<double>& values() const { return values_; }
  const Solution& solution() const { return solution_; }

 private:
  double sigma(std::size_t i) const {
    return data_.has_noise() ? data_.noise[i] : std::abs(data_.response[i]);
  }
  std::size_t place(std::size_t parameter) const {
    return static_cast<std::size_t>(
        std::count(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(parameter), false));
  }
  std::vector<double> values_at(std::span<const double> coordinates) const {
    std::vector<double> values = values_;
    for (std::size_t i = 0, at = 0; i < values.size(); ++i)
      if (!held_[i]) values[i] = model_.parameters()[i].value(coordinates[at++]);
    return values;
  }
  void residuals(std::span<const double> coordinates, std::span<double> out) const {
    const std::vector<double> values = values_at(coordinates);
    for (std::size_t i = 0; i < data_.size(); ++i) {
      const Complex r = (data_.response[i] - model_.at(values, data_.frequency_hz[i])) / sigma(i);
      out[2 * i] = r.real();
      out[2 * i + 1] = r.imag();
    }
  }
  void solve() {
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
  std::size_t vaguest() const {
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
  bool pole_is_nowhere() const {
    if (model_.choice().finger || held_[kPole]) return false;
    const ModelParameter& pole = model_.parameters()[kPole];
    return values_[kPole] > kNowhere * pole.high || values_[kPole] < pole.low / kNowhere;
  }
  std::vector<double> log_gradient(double hz) const {
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

  const BodeData& data_;
  const ResponseModel& model_;
  std::vector<double> values_;
  std::vector<bool> held_;
  Solution solution_;
};

double r_squared_of(const BodeData& data, std::span<const Complex> modelled) {
  const Complex mean = std::accumulate(data.response.begin(), data.response.end(), Complex()) /
                       static_cast<double>(data.size());
  double left = 0, whole = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    left += std::norm(data.response[i] - modelled[i]);
    whole += std::norm(data.response[i] - mean);
  }
  return 1 - left / whole;
}

std::vector<Complex> turned_residuals(const BodeData& data, std::span<const Complex> modelled) {
  std::vector<Complex> list;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double sigma = data.has_noise() ? data.noise[i] : std::abs(data.response[i]);
    list.push_back((data.response[i] - modelled[i]) / sigma * std::polar(1.0, -std::arg(modelled[i])));
  }
  return list;
}

void put_curve(const Fitter& fitter, const ResponseModel& model, double times, ResponseFit& fit) {
  const double low_hz = fit.data.frequency_hz.front(), high_hz = fit.data.frequency_hz.back();
  for (int i = 0; i < kCurvePoints; ++i) {
    const double hz = low_hz * std::pow(high_hz / low_hz, i / (kCurvePoints - 1.0));
    fit.curve_hz.push_back(hz);
    fit.curve.push_back(model.at(fitter.values(), hz));
    if (fit.claims_intervals()) fit.band.push_back(times * fitter.spread(hz));
  }
}

void put_parameters(const Fitter& fitter, const ResponseModel& model, ResponseFit& fit) {
  const double freedom = 2 * static_cast<double>(fit.data.size()) - static_cast<double>(fitter.free_count());
  const double times = fit.data.has_noise() ? kNormal95 : student_95(freedom);
  for (std::size_t i = 0; i < fitter.values().size(); ++i) {
    const ModelParameter& p = model.parameters()[i];
    FittedParameter fitted{p.name, fitter.values()[i], fitter.values()[i], fitter.values()[i],
                           fitter.held(i)};
    if (!fitter.held(i) && fit.claims_intervals()) {
      const double c = p.coordinate(fitted.value), half = times * fitter.standard_error(i);
      fitted.low = p.value(c - half);
      fitted.high = p.value(c + half);
    }
    if (fitter.held(i))
      fit.notes.push_back(fmt::format(
          "{} can't be told from the other parameters in this band: held at {:.4g}", p.name, fitted.value));
    fit.parameters.push_back(std::move(fitted));
  }
  put_curve(fitter, model, times, fit);
}

// Of a starting point, the fit with everything but what it suggests.
ResponseFit fitted_from(const BodeData& data, const ResponseModel& model, std::vector<double> start) {
  ResponseFit fit;
  fit.data = data;
  Fitter fitter(fit.data, model, std::move(start));
  fitter.run();
  for (const double hz : data.frequency_hz) fit.modelled.push_back(model.at(fitter.values(), hz));
  fit.converged = fitter.solution().converged;
  fit.ended = fitter.ended();
  fit.iterations = fitter.solution().iterations;
  fit.condition = fitter.solution().condition;
  fit.r_squared = r_squared_of(data, fit.modelled);
  fit.misfit = misfit_of(turned_residuals(data, fit.modelled), fitter.free_count(), data.has_noise());
  fit.transducer = model.transducer(fitter.values());
  put_parameters(fitter, model, fit);
  return fit;
}

double left_by(const ResponseFit& fit) {
  double sum = 0;
  for (const Complex& r : turned_residuals(fit.data, fit.modelled)) sum += std::norm(r);
  return sum;
}

std::vector<double> values_of(const ResponseFit& fit) {
  std::vector<double> values;
  for (const FittedParameter& p : fit.parameters) values.push_back(p.value);
  return values;
}

// Of several starts the fit that leaves least: a second mode has false minima, one mode none that was seen.
ResponseFit best_fit(const BodeData& data, const ResponseModel& model) {
  if (!model.choice().second_mode) return fitted_from(data, model, starting_values(model, data).values);
  ModelChoice one = model.choice();
  one.second_mode = one.lag = false;
  const ResponseModel single(one, model.base(), data);
  const std::vector<double> first =
      values_of(fitted_from(data, single, starting_values(single, data).values));
  std::optional<ResponseFit> best;
  for (const Start& start : second_mode_starts(model, data, first)) {
    ResponseFit fit = fitted_from(data, model, start.values);
    if (!best || left_by(fit) < left_by(*best)) best = std::move(fit);
  }
  return *best;
}

// Two resonances multiply: which is called the first is free, so it is the lower.
std::vector<double> in_order(std::vector<double> values, const ModelChoice& choice) {
  if (!choice.second_mode || choice.finger || values[kSecondMode] > values[kResonance]) return values;
  std::swap(values[kSecondMode], values[kResonance]);
  std::swap(values[kSecondMode + 1], values[kDamping]);
  return values;
}

// The hold is taken out with the model of the first fit: what that is wrong by comes back as 2e-4 of it.
ResponseFit fit_once(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base) {
  const ResponseModel model(choice, base, data);
  const BodeData near = without_hold(data, [&](double hz) { return schema::actuator_response(base, hz); });
  ResponseFit fit = best_fit(near, model);
  const std::vector<double> values = in_order(values_of(fit), choice);
  if (!(data.held_rate_hz > 0) && values == values_of(fit)) return fit;
  const BodeData nearer = without_hold(data, [&](double hz) { return model.at(values, hz); });
  return fitted_from(nearer, model, values);
}

// What was claimed before the fit turned out to be none.
void claim_nothing(ResponseFit& fit) {
  fit.band.clear();
  for (FittedParameter& p : fit.parameters) p.low = p.high = p.value;
}

struct Extension {
  ResponseFit fit;
  double left = 1;  // of what the plain model leaves
};

std::optional<Extension> extended(const BodeData& data, const ResponseFit& plain, ModelChoice choice,
                                  bool ModelChoice::*what, const schema::Transducer& base) {
  if (choice.*what || choice.finger || data.size() < 2 * kLeastFrequencies) return std::nullopt;
  choice.*what = true;
  Extension extension{fit_once(data, choice, base), 1};
  extension.left = left_by(extension.fit) / left_by(plain);
  return extension;
}

std::string percent(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

// Whether what was found as a second mode is one: between the ends of the band, and not the first's resonance
// once more, as it is where the first is bent to explain something else.
bool is_a_mode(const Extension& mode, const ResponseFit& plain) {
  const double second_hz = mode.fit.find("second_mode_hz")->value,
               apart = std::abs(std::log(second_hz / plain.find("resonance_hz")->value));
  return mode.fit.converged && second_hz < mode.fit.data.frequency_hz.back() && apart > kApart;
}

// What would explain the misfit: tried, not guessed.
void suggest(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
             ResponseFit& fit) {
  const auto mode = extended(data, fit, choice, &ModelChoice::second_mode, base);
  const auto lag = extended(data, fit, choice, &ModelChoice::lag, base);
  const double by_mode = mode && is_a_mode(*mode, fit) ? mode->left : 1, by_lag = lag ? lag->left : 1;
  fit.one_mode_short = by_mode < kExplains && by_mode < by_lag;
  if (fit.one_mode_short)
    fit.suggestion = fmt::format(
        "the model is one mode short: one at {:.4g} Hz leaves {} of the residuals (--second-mode)",
        mode->fit.find("second_mode_hz")->value, percent(by_mode));
  else if (by_lag < kExplains)
    fit.suggestion = fmt::format(
        "a lag of {:.2g} degrees leaves {} of the residuals: a hysteresis (--lag, or --method loop)",
        kDegrees * lag->fit.find("lag_rad")->value, percent(by_lag));
  else
    fit.suggestion = "neither a second mode nor a lag explains it";
  if (data.third_harmonic.value_or(0) > kNonlinear)
    fit.suggestion += fmt::format("; the answer has a third harmonic of {}: the device is not linear{}",
                                  percent(*data.third_harmonic),
                                  by_lag < kExplains ? "" : " (--method loop finds a hysteresis)");
}

}  // namespace

const FittedParameter* ResponseFit::find(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &FittedParameter::name);
  return found == parameters.end() ? nullptr : &*found;
}

double student_95(double freedom) {
  const double z = kNormal95, n = freedom;
  return z + (std::pow(z, 3) + z) / (4 * n) +
         (5 * std::pow(z, 5) + 16 * std::pow(z, 3) + 3 * z) / (96 * n * n) +
         (3 * std::pow(z, 7) + 19 * std::pow(z, 5) + 17 * std::pow(z, 3) - 15 * z) / (384 * n * n * n);
}

namespace {

std::vector<double> shares_of(const ResponseFit& fit) {
  std::vector<double> shares;
  for (const Complex& r : turned_residuals(fit.data, fit.modelled)) shares.push_back(std::norm(r));
  return shares;
}

// One value that holds most of what is left, whether or not that looked like noise.
bool finds_outlier(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
                   ResponseFit& fit) {
  const std::vector<double> shares = shares_of(fit);
  const double left = left_by(fit);
  if (!fit.misfit.found && *std::ranges::max_element(shares) < kExplains * left) return false;
  const auto found = outlier_of(data, shares, left,
                                [&](const BodeData& rest) { return left_by(fit_once(rest, choice, base)); });
  if (!found) return false;
  fit.misfit.found = true;
  fit.misfit.words = fmt::format("frequency {} ({:.4g} Hz) is off: without it {} of the residuals are left",
                                 found->index + 1, data.frequency_hz[found->index], percent(found->left));
  fit.suggestion = "measure it again, or leave its line out";
  return true;
}

// Relative residuals of values far too large are small: R^2 tells those.
void distrust(ResponseFit& fit) {
  if (fit.misfit.found || fit.data.has_noise() || fit.r_squared > kExplains) return;
  fit.misfit.found = true;
  fit.misfit.words = fmt::format("R^2 is {:.3g}: some values are far from the rest", fit.r_squared);
}

}  // namespace

ResponseFit fit_response(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base) {
  ResponseFit fit = fit_once(data, choice, base);
  const bool sound = fit.claims_intervals();
  if (!finds_outlier(data, choice, base, fit)) {
    distrust(fit);
    if (fit.misfit.found) suggest(data, choice, base, fit);
  }
  if (sound && fit.misfit.found) claim_nothing(fit);
  return fit;
}

std::vector<std::string> held_words(const ModelChoice& choice, const schema::Transducer& base) {
  if (choice.finger)
    return {fmt::format("all of '{}' is held: only stiffness, damping and mass are added to it", base.name)};
  const bool actuator = choice.direction == Direction::actuator;
  return {fmt::format("gain, beta and the amplifier's gain show only as their product: delta {:.4g} m, v_max "
                      "{:.4g} V and "
                      "{} are held, {} is fitted",
                      base.deflection_m, base.max_voltage_v, actuator ? "G_a" : "G_s",
                      actuator ? "actuator_scale" : "sensor_scale"),
          fmt::format("k_r, k_p and m show only as (k_r + k_p) / m: k_r {:.4g} N/m and k_p {:.4g} N/m are "
                      "held, m is fitted",
                      base.flexure_stiffness_n_per_m, base.bender_stiffness_n_per_m),
          fmt::format("{} and C_p show only as their product: C_p {:.4g} F is held", actuator ? "R_a" : "R_s",
                      base.capacitance_f)};
}

}  // namespace tacto::analysis

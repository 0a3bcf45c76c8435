// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/response_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "analysis/identify/fit/outlier.hpp"
#include "analysis/identify/fit/pure_delay.hpp"
#include "analysis/identify/fit/response_fitter.hpp"
#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/fit/starting_values.hpp"
#include "analysis/identify/fit/three_poles.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/hold.hpp"
#include "analysis/identify/measure/noise_shape.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;

constexpr int kCurvePoints = 101;
constexpr int kNoiseRounds = 2;    // of fit and noise in turn: a third moves nothing by a tenth of its error
constexpr double kExplains = 0.5;  // of what a misfit leaves
constexpr double kSuspect = 0.2;   // of what is left, in one value: of 16 values on a reason to look
constexpr double kSame = 1e-6;     // of what is left, and of a pole's logarithm: the same minimum
constexpr double kApart = 0.05;    // of two resonances that are two
constexpr double kNonlinear = 5e-3;  // third harmonic: above what a 16-bit converter makes of itself

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

void put_curve(const ResponseFitter& fitter, const ResponseModel& model, ResponseFit& fit) {
  const double low_hz = fit.data.frequency_hz.front(), high_hz = fit.data.frequency_hz.back();
  for (int i = 0; i < kCurvePoints; ++i) {
    const double hz = low_hz * std::pow(high_hz / low_hz, i / (kCurvePoints - 1.0));
    fit.curve_hz.push_back(hz);
    fit.curve.push_back(model.at(fitter.values(), hz));
    if (fit.claims_intervals()) fit.band.push_back(fitter.times_95() * fitter.spread(hz));
  }
}

void note_overdamped(const ResponseModel& model, std::span<const double> values, ResponseFit& fit) {
  if (model.choice().finger || model.choice().second_mode) return;
  const auto splits = other_splits(model.choice().direction, values);
  if (splits.empty()) return;
  fit.notes.push_back(
      fmt::format("the mode is overdamped: of three real poles at {:.4g}, {:.4g} and {:.4g} Hz, a "
                  "response can't show which is the electrical one; pole_hz is the one nearest '{}'",
                  splits[0][kPole], splits[1][kPole], values[kPole], model.base().name));
}

void put_parameters(const ResponseFitter& fitter, const ResponseModel& model, ResponseFit& fit) {
  for (std::size_t i = 0; i < fitter.values().size(); ++i) {
    const ModelParameter& p = model.parameters()[i];
    FittedParameter fitted{p.name, fitter.values()[i], fitter.values()[i], fitter.values()[i],
                           fitter.held(i)};
    if (!fitter.held(i) && fit.claims_intervals()) {
      const double c = p.coordinate(fitted.value), half = fitter.times_95() * fitter.standard_error(i);
      fitted.low = p.value(c - half);
      fitted.high = p.value(c + half);
    }
    if (fitter.held(i))
      fit.notes.push_back(fmt::format("{} is not separately identifiable in this band: held at {:.4g}",
                                      p.name, fitted.value));
    fit.parameters.push_back(std::move(fitted));
  }
  note_overdamped(model, fitter.values(), fit);
  put_curve(fitter, model, fit);
}

// Of a starting point, the fit with everything but what it suggests.
ResponseFit fitted_from(const BodeData& data, const ResponseModel& model, std::vector<double> start) {
  ResponseFit fit;
  fit.data = data;
  ResponseFitter fitter(fit.data, model, std::move(start));
  fitter.run();
  for (const double hz : data.frequency_hz) fit.modelled.push_back(model.at(fitter.values(), hz));
  fit.converged = fitter.solution().converged;
  fit.ended = fitter.ended();
  fit.iterations = fitter.solution().iterations;
  fit.condition = fitter.solution().condition;
  fit.r_squared = r_squared_of(data, fit.modelled);
  const auto residuals = turned_residuals(data, fit.modelled);
  fit.misfit = misfit_of(residuals, fitter.free_count(), data.noise_is_measured());
  // Under a bound there may be anything.
  if (data.noise_is_a_bound && fit.misfit.reduced_chi_squared <= fit.misfit.chi_squared_limit)
    fit.misfit.found = false, fit.misfit.words.clear();
  if (data.noise_from_residuals) fit.evenness = evenness_of(residuals, data.frequency_hz);
  if (fit.evenness.uneven) fitter.take_uneven_noise();
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

// Of equal fits, as of three real poles, the one whose pole is nearest the base's.
bool is_better(const ResponseFit& fit, const ResponseFit& than, const ResponseModel& model) {
  const double left = left_by(fit), other = left_by(than);
  if (std::abs(left - other) > kSame * other) return left < other;
  const auto off = [&](const ResponseFit& of) {
    return std::abs(std::log(of.parameters[kPole].value / model.parameters()[kPole].base));
  };
  return off(fit) < off(than) - kSame;
}

// A complex pair can only be the mode's: where it would have to be made of the pole and one of the mode's,
// the fit stands in a corner, and goes on once the roles are swapped.
ResponseFit with_roles_swapped(const BodeData& data, const ResponseModel& model, ResponseFit fit) {
  for (auto& values : other_splits(data.direction, values_of(fit))) {
    ResponseFit other = fitted_from(data, model, std::move(values));
    if (is_better(other, fit, model)) fit = std::move(other);
  }
  return fit;
}

ResponseFit best_of_one_mode(const BodeData& data, const ResponseModel& model) {
  std::optional<ResponseFit> best;
  for (auto& start : one_mode_starts(model, data)) {
    ResponseFit fit = fitted_from(data, model, std::move(start));
    if (!best || left_by(fit) < (1 - kSame) * left_by(*best)) best = std::move(fit);
  }
  return model.choice().finger ? *best : with_roles_swapped(data, model, std::move(*best));
}

// Of several starts the fit that leaves least.
ResponseFit best_fit(const BodeData& data, const ResponseModel& model) {
  if (!model.choice().second_mode) return best_of_one_mode(data, model);
  ModelChoice one = model.choice();
  one.second_mode = one.lag = false;
  const ResponseModel single(one, model.base(), data);
  const std::vector<double> first = values_of(best_of_one_mode(data, single));
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

// Of what is left when neither a second mode nor a lag explains it.
std::string words_of_delay(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
                           const ResponseFit& plain) {
  constexpr const char* kUnexplained = "neither a second mode nor a lag explains it";
  if (choice.finger || data.size() < 2 * kLeastFrequencies) return kUnexplained;
  const double left = left_by(plain);
  const PureDelay found = best_delay(
      data, [&](const BodeData& earlier) { return left_by(fit_once(earlier, choice, base)) / left; });
  if (found.left >= kExplains) return std::string(kUnexplained) + ", nor a delay";
  return fmt::format(
      "without {} of {:.4g} us {} of the residuals are left: take it out of the phases ({:.4g} degrees a Hz)",
      found.delay_s > 0 ? "a delay, as converters and filters have one," : "a lead",
      1e6 * std::abs(found.delay_s), percent(found.left), 360 * std::abs(found.delay_s));
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
        "a lag of {:.2g} degrees leaves {} of the residuals: a hysteresis (on a device --method joint fits "
        "it; "
        "else --lag)",
        kDegrees * lag->fit.find("lag_rad")->value, percent(by_lag));
  else
    fit.suggestion = words_of_delay(data, choice, base, fit);
  if (data.third_harmonic.value_or(0) > kNonlinear)
    fit.suggestion += fmt::format(
        "; the answer has a third harmonic of {}: the device is not linear{}", percent(*data.third_harmonic),
        by_lag < kExplains ? "" : " (on a device --method joint fits a hysteresis)");
}

}  // namespace

const FittedParameter* ResponseFit::find(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &FittedParameter::name);
  return found == parameters.end() ? nullptr : &*found;
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
  const double suspect = data.noise_from_residuals ? kSuspect : kExplains;
  if (!fit.misfit.found && *std::ranges::max_element(shares) < suspect * left) return false;
  const auto found = outlier_of(data, shares, left, [&](const BodeData& rest) {
    const ResponseFit other = fit_once(rest, choice, base);
    return RestOfFit{left_by(other), other.claims_intervals()};
  });
  if (!found) return false;
  fit.misfit.found = true;
  fit.misfit.words = fmt::format("frequency {} ({:.4g} Hz) is off: without it {} of the residuals are left",
                                 found->index + 1, data.frequency_hz[found->index], percent(found->left));
  fit.suggestion = "measure it again, or leave its line out";
  return true;
}

// Where nobody measured the noise, as the residuals have it: constant and proportional ones bend a fit apart.
BodeData with_noise_known(BodeData data, const ModelChoice& choice, const schema::Transducer& base) {
  if (data.has_noise()) return data;
  for (int round = 0; round < kNoiseRounds; ++round) {
    const ResponseFit fit = fit_once(data, choice, base);
    data = with_noise_of_residuals(std::move(data), fit.modelled, fit.parameters.size());
  }
  return data;
}

BodeData without_noise(BodeData data) {
  data.noise.clear();
  data.noise_freedom = 0;
  return data;
}

// Relative residuals of values far too large are small: R^2 tells those.
void distrust(ResponseFit& fit) {
  if (fit.misfit.found || fit.data.noise_is_measured() || fit.r_squared > kExplains) return;
  fit.misfit.found = true;
  fit.misfit.words = fmt::format("R^2 is {:.3g}: some values are far from the rest", fit.r_squared);
}

}  // namespace

ResponseFit fit_values(const BodeData& measured, const ModelChoice& choice, const schema::Transducer& base) {
  return fit_once(with_noise_known(measured, choice, base), choice, base);
}

ResponseFit fit_response(const BodeData& measured, const ModelChoice& choice,
                         const schema::Transducer& base) {
  const BodeData data = with_noise_known(measured, choice, base);
  ResponseFit fit = fit_once(data, choice, base);
  if (const double times = fit.misfit.noise_overstated; times > 0 && !data.noise_is_a_bound) {
    fit = fit_response(without_noise(measured), choice, base);
    fit.noise_overstated = times;
    return fit;
  }
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

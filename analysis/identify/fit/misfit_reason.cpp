// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/misfit_reason.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/fit/three_poles.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/noise_shape.hpp"

namespace tacto::analysis {
namespace {

constexpr double kExplains = 0.5;    // ratio of the residuals' squares
constexpr double kApart = 0.05;      // smallest logarithmic distance of two different resonances
constexpr double kNonlinear = 5e-3;  // third harmonic; a 16-bit converter causes less
constexpr int kToAPeriod = 8;        // steps of the delay

// The inputs of a fit, and the fit of the plain model.
struct FittedBench {
  const BodeData& data;
  const ModelChoice& choice;
  const schema::Transducer& base;
  const ResponseFit& plain;
};

struct Extension {
  ResponseFit fit;
  double left = 1;     // residuals' squares relative to the plain model's
  double delay_s = 0;  // removed from the phases

  Extension(ResponseFit made, const ResponseFit& plain, double taken_s = 0)
      : fit(std::move(made)), left(left_by(fit) / left_by(plain)), delay_s(taken_s) {}
};

// If the noise was not measured, it is estimated from the residuals of this fit, because an estimate from the
// plain fit has the shape of the effect that the plain model lacks.
bool leaves_noise(const ResponseFit& fit) {
  if (!fit.converged) return false;
  if (!fit.data.noise_from_residuals) return !fit.misfit.found;
  const std::size_t parameters = fit.parameters.size();
  const auto residuals =
      turned_residuals(with_noise_of_residuals(fit.data, fit.modelled, parameters), fit.modelled);
  return !misfit_of(residuals, parameters, false).found &&
         !evenness_of(residuals, fit.data.frequency_hz).uneven;
}

bool can_extend(const FittedBench& of) {
  return !of.choice.finger && of.data.size() >= 2 * kLeastFrequencies;
}

std::optional<Extension> extended(const FittedBench& of, bool ModelChoice::*what) {
  if (of.choice.*what || !can_extend(of)) return std::nullopt;
  ModelChoice choice = of.choice;
  choice.*what = true;
  return Extension(fit_values(of.data, choice, of.base), of.plain);
}

// The product of two resonances does not determine their order: the second is the higher one.
double second_mode_hz(const ResponseFit& mode) {
  return std::max(mode.find("second_mode_hz")->value, mode.find("resonance_hz")->value);
}

double first_mode_hz(const ResponseFit& mode) {
  return std::min(mode.find("second_mode_hz")->value, mode.find("resonance_hz")->value);
}

// Whether a fitted second mode is plausible: below the upper end of the band, and not equal to the first
// resonance, as happens if the first is distorted to explain another effect.
bool is_a_mode(const ResponseFit& mode, const ResponseFit& plain) {
  const double second_hz = second_mode_hz(mode);
  const auto is_apart = [&](double hz) { return std::abs(std::log(second_hz / hz)) > kApart; };
  if (!mode.converged || second_hz >= mode.data.frequency_hz.back()) return false;
  return is_apart(plain.find("resonance_hz")->value) || (is_apart(first_mode_hz(mode)) && leaves_noise(mode));
}

BodeData earlier_by(BodeData data, double delay_s) {
  for (std::size_t i = 0; i < data.size(); ++i)
    data.response[i] *= std::polar(1.0, kTurn * data.frequency_hz[i] * delay_s);
  return data;
}

// For one mode two starting points are sufficient; a second mode has local minima and needs all of them.
double left_without_delay(const FittedBench& of, double delay_s) {
  const BodeData earlier = earlier_by(of.plain.data, delay_s);
  if (of.choice.second_mode || of.choice.lag) return left_by(fit_values(earlier, of.choice, of.base));
  const double left = left_by(fit_from(earlier, of.choice, of.base, values_of(of.plain)));
  const auto poles = poles_of_data(earlier);
  return poles ? std::min(left, left_by(fit_from(earlier, of.choice, of.base, *poles))) : left;
}

double rough_delay_s(const FittedBench& of) {
  const double step_s = 1 / (kToAPeriod * of.data.frequency_hz.back());
  double best_s = 0, least = left_by(of.plain);
  for (int i = -kMostDelayPeriods * kToAPeriod; i <= kMostDelayPeriods * kToAPeriod; ++i)
    if (const double left = left_without_delay(of, i * step_s); left < least)
      least = left, best_s = i * step_s;
  return best_s;
}

// Fits the delay as a parameter, from a near value on. The other starting values are those of a fit to the
// response with that delay removed.
Extension with_delay(const FittedBench& of, ModelChoice choice, double near_s) {
  const BodeData earlier = earlier_by(of.plain.data, near_s);
  std::vector<double> values = values_of(fit_values(earlier, choice, of.base));
  values.insert(values.end() - (choice.lag ? 1 : 0), 0.0);
  choice.delay = true;
  ResponseFit fit = fit_from(earlier, choice, of.base, std::move(values));
  const double delay_s = near_s + 1e-3 * fit.find("delay_ms")->value;
  return {std::move(fit), of.plain, delay_s};
}

std::optional<Extension> with_mode_and_delay(const FittedBench& of, double rough_s) {
  if (of.choice.second_mode) return std::nullopt;
  ModelChoice both = of.choice;
  both.second_mode = true;
  Extension best = with_delay(of, both, rough_s);
  if (Extension near_none = with_delay(of, both, 0); near_none.left < best.left) best = std::move(near_none);
  if (!is_a_mode(best.fit, of.plain) || !leaves_noise(best.fit)) return std::nullopt;
  return best;
}

std::string percent(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

std::string words_of_phases(double delay_s) {
  return fmt::format("remove it from the phases ({:.4g} degrees per Hz)", 360 * std::abs(delay_s));
}

std::string delay_words(double delay_s) {
  return fmt::format("{} of {:.4g} us",
                     delay_s > 0 ? "a delay, as converters and filters have one," : "a lead",
                     1e6 * std::abs(delay_s));
}

MisfitReason reason_of(const Extension& by, std::string words, bool one_mode_short = false) {
  return {std::move(words), one_mode_short, false, by.left, leaves_noise(by.fit)};
}

MisfitReason mode_reason(const Extension& mode) {
  return reason_of(mode,
                   fmt::format("the model lacks one mode: a mode at {:.4g} Hz leaves {} of the residuals "
                               "(--second-mode)",
                               second_mode_hz(mode.fit), percent(mode.left)),
                   true);
}

MisfitReason lag_reason(const Extension& lag) {
  MisfitReason reason =
      reason_of(lag, fmt::format("a lag of {:.2g} degrees leaves {} of the residuals: a hysteresis (on a "
                                 "device --method joint fits it; else --lag)",
                                 kDegrees * lag.fit.find("lag_rad")->value, percent(lag.left)));
  reason.is_lag = true;
  return reason;
}

MisfitReason delay_reason(const Extension& late) {
  return reason_of(late, fmt::format("without {} {} of the residuals are left: {}", delay_words(late.delay_s),
                                     percent(late.left), words_of_phases(late.delay_s)));
}

MisfitReason both_reason(const Extension& both) {
  return reason_of(
      both,
      fmt::format("the model lacks one mode, and the phases are shifted: a mode at {:.4g} Hz and {} "
                  "leave {} of the residuals: {}, then --second-mode",
                  second_mode_hz(both.fit), delay_words(both.delay_s), percent(both.left),
                  words_of_phases(both.delay_s)),
      true);
}

// One effect only.
MisfitReason single_reason(const FittedBench& of, std::optional<double>& rough_s) {
  const auto mode = extended(of, &ModelChoice::second_mode), lag = extended(of, &ModelChoice::lag);
  const double by_mode = mode && is_a_mode(mode->fit, of.plain) ? mode->left : 1,
               by_lag = lag ? lag->left : 1;
  if (by_mode < kExplains && by_mode < by_lag) return mode_reason(*mode);
  if (by_lag < kExplains) return lag_reason(*lag);
  MisfitReason none{"neither a second mode nor a lag explains it"};
  if (!can_extend(of)) return none;
  rough_s = rough_delay_s(of);
  const Extension late = with_delay(of, of.choice, *rough_s);
  if (late.left < kExplains) return delay_reason(late);
  none.words += ", nor a delay";
  return none;
}

}  // namespace

MisfitReason misfit_reason(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
                           const ResponseFit& plain) {
  const FittedBench of{data, choice, base, plain};
  std::optional<double> rough_s;
  MisfitReason reason = single_reason(of, rough_s);
  if (!reason.is_noise && can_extend(of)) {
    const auto both = with_mode_and_delay(of, rough_s ? *rough_s : rough_delay_s(of));
    if (both && both->left < kExplains * reason.left) reason = both_reason(*both);
  }
  if (data.third_harmonic.value_or(0) > kNonlinear)
    reason.words += fmt::format("; the response has a third harmonic of {}: the device is not linear{}",
                                percent(*data.third_harmonic),
                                reason.is_lag ? "" : " (on a device --method joint fits a hysteresis)");
  return reason;
}

}  // namespace tacto::analysis

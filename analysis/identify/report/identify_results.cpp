// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/report/identify_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/report/bode_figure.hpp"
#include "data-schema/report/value_text.hpp"

namespace tacto::analysis {
namespace {

using schema::ResultCurve;
using schema::ResultPicture;
using schema::Results;

constexpr double kLeastDigits = 5, kMostDigits = 17;  // a double has 17 significant digits

// Decimal exponent of the first digit: 2 for 547.7, -5 for 2e-05.
double place_of(double value) {
  return std::floor(std::log10(std::abs(value)));
}

int digits_of(const FittedParameter& p) {
  const double shows_two = place_of(p.value) - place_of(0.5 * (p.high - p.low)) + 2;
  return static_cast<int>(std::clamp(shows_two, kLeastDigits, kMostDigits));
}

constexpr const char* kBodeFrequency = "frequency (Hz)";

Results begun_results(const schema::Transducer& found) {
  const schema::Identification& about = *found.identification;
  Results results;
  results.simulated = about.simulated;
  const char* const verdict = about.usable() ? "fits" : about.converged ? "MISFIT" : "DID NOT CONVERGE";
  results.figures = {{"transducer", found.name},
                     {"verdict", fmt::format("{}: {}", verdict, about.words)},
                     {"conditions", fmt::format("{}, {}", about.source, about.conditions)},
                     {"valid", fmt::format("{:.4g} to {:.4g} Hz", about.low_hz, about.high_hz)},
                     {"R^2", fmt::format("{:.6g}", about.r_squared)}};
  return results;
}

void add_identifiability(const ResponseFit& fit, const schema::Transducer& base, Results& results) {
  for (FittedParameter p : fit.parameters) {
    std::string name = cli::label_with_unit(p.name);
    if (p.name == "gain_m_per_v") {
      name = "gain (\u00B5m/V)";
      for (double* value : {&p.value, &p.low, &p.high}) *value *= 1e6;
    }
    results.figures.push_back({name + ", 95 %", interval_words(p, fit.claims_intervals())});
  }
  for (const std::string& line : held_words(fit.choice, base))
    results.figures.push_back({"not separately identifiable", line});
  for (const std::string& line : fit.notes) results.figures.push_back({"not separately identifiable", line});
}

void add_models(const ResponseFit& fit, Results& results) {
  if (!fit.choice_words.empty()) results.figures.push_back({"model", fit.choice_words});
  for (const TriedModel& model : fit.tried)
    results.figures.push_back({"error on left-out frequencies: " + model.name,
                               model.converged
                                   ? fmt::format("{:.3g} % with {} parameters{}", 100 * model.left_out,
                                                 model.parameters, model.misfit ? ", a misfit" : "")
                                   : "did not converge"});
}

void add_residual_figures(const ResponseFit& fit, Results& results) {
  results.figures.push_back({"condition number", fmt::format("{:.4g}", fit.condition)});
  if (fit.data.noise_is_measured())
    results.figures.push_back({"residuals over the noise, squared",
                               fmt::format("{:.3g}, at most {:.3g}", fit.misfit.reduced_chi_squared,
                                           fit.misfit.chi_squared_limit)});
  results.figures.push_back(
      {"residuals of neighbours, correlation",
       fmt::format("phase {:.2f}, amplitude {:.2f}, at most {:.2f}", fit.misfit.phase_correlation,
                   fit.misfit.amplitude_correlation, fit.misfit.correlation_limit)});
}

ResultPicture amplitude_picture(const ResponseFit& fit, const BodeCurves& c) {
  ResultPicture picture{"Amplitude", kBodeFrequency, "dB re the gain at rest", true, {}};
  picture.curves = {{"data", fit.data.frequency_hz, c.data_db}, {"model", fit.curve_hz, c.model_db}};
  if (!c.low_db.empty()) {
    picture.curves.push_back({"95 % band", fit.curve_hz, c.low_db, true});
    picture.curves.push_back({"", fit.curve_hz, c.high_db, true});
  }
  picture.curves.push_back({"inverse", fit.curve_hz, c.inverse_db});
  return picture;
}

std::vector<ResultPicture> bode_pictures(const ResponseFit& fit) {
  const BodeCurves c = bode_curves(fit);
  ResultPicture phase{"Phase", kBodeFrequency, "degrees", true, {}};
  phase.curves = {{"data", fit.data.frequency_hz, c.data_deg},
                  {"model", fit.curve_hz, c.model_deg},
                  {"inverse", fit.curve_hz, c.inverse_deg}};
  ResultPicture residuals{"Residuals", kBodeFrequency, "over the noise", true, {}};
  residuals.curves = {{"amplitude", fit.data.frequency_hz, c.along},
                      {"phase", fit.data.frequency_hz, c.across}};
  return {amplitude_picture(fit, c), phase, residuals};
}

void add_loops(const LoopFit& fit, Results& results) {
  results.figures.push_back(
      {"loop", fmt::format("{:.3g} % open at {:.3g} V", 100 * fit.opening, fit.amplitude_v)});
  results.figures.push_back({"lag", fmt::format("{:.3g} degrees", kDegrees * fit.lag_rad)});
  results.figures.push_back({"left", fmt::format("{:.2g} % by the operator, {:.3g} % by a line",
                                                 100 * fit.residual_part, 100 * fit.linear_residual_part)});
  constexpr std::size_t kMostLoopPoints = 1000;
  ResultCurve measured{"measured", {}, {}}, model{"operator", {}, {}, true};
  const std::size_t step = fit.loop_v.size() / kMostLoopPoints + 1;
  for (std::size_t i = 0; i < fit.loop_v.size(); i += step) {
    measured.x.push_back(fit.loop_v[i]);
    measured.y.push_back(1e6 * fit.loop_m[i]);
    model.y.push_back(1e6 * fit.loop_model_m[i]);
  }
  model.x = measured.x;
  results.pictures.push_back({"Loop", "drive (V)", "displacement (\u00B5m)", false, {measured, model}});
  results.pictures.push_back({"Operator",
                              "threshold (V)",
                              "weight",
                              false,
                              {{"", fit.hysteresis.thresholds_v, fit.hysteresis.weights}}});
}

std::string spread_words(const Spread& s, const char* unit) {
  return fmt::format("{:.4g}{}, spread {:.2g}, standard deviation {:.2g}, {:.4g} to {:.4g}", s.median, unit,
                     s.spread, s.standard_deviation, s.least, s.most);
}

std::vector<ResultPicture> tap_pictures(const TapsFit& fit) {
  ResultCurve frequencies{"", {}, {}}, dampings{"", {}, {}};
  for (std::size_t i = 0; i < fit.taps.size(); ++i) {
    frequencies.x.push_back(static_cast<double>(i + 1));
    frequencies.y.push_back(fit.taps[i].modes.front().frequency_hz);
    dampings.y.push_back(fit.taps[i].modes.front().damping_ratio);
  }
  dampings.x = frequencies.x;
  return {{"Resonance by tap", "tap", "Hz", false, {frequencies}},
          {"Damping by tap", "tap", "ratio", false, {dampings}}};
}

}  // namespace

std::string interval_words(const FittedParameter& p, bool claimed) {
  if (p.held) return fmt::format("{:.5g}, held", p.value);
  if (!claimed) return fmt::format("{:.5g}, without interval", p.value);
  const int digits = digits_of(p);
  return fmt::format("{:#.{}g} ({:#.{}g} to {:#.{}g})", p.value, digits, p.low, digits, p.high, digits);
}

bool interval_is_hidden(const FittedParameter& p, int digits) {
  return fmt::format("{:.{}g}", p.low, digits) == fmt::format("{:.{}g}", p.high, digits);
}

Results identify_results(const ResponseFit& fit, const schema::Transducer& base,
                         const schema::Transducer& found) {
  Results results = begun_results(found);
  add_models(fit, results);
  add_identifiability(fit, base, results);
  add_residual_figures(fit, results);
  results.pictures = bode_pictures(fit);
  return results;
}

Results identify_results(const LoopFit& fit, const schema::Transducer& found) {
  Results results = begun_results(found);
  add_loops(fit, results);
  return results;
}

Results identify_results(const JointFit& fit, const schema::Transducer& base,
                         const schema::Transducer& found) {
  Results results = identify_results(fit.response, base, found);
  if (fit.has_hysteresis) add_loops(fit.loops, results);
  return results;
}

Results identify_results(const TapsFit& fit, const TapsPrediction& predicted,
                         const schema::Transducer& found) {
  Results results = begun_results(found);
  results.figures.push_back({"resonance", spread_words(fit.resonance_hz, " Hz")});
  results.figures.push_back({"damping ratio", spread_words(fit.damping_ratio, "")});
  results.figures.push_back(
      {fmt::format("taps 1-{} predict {} others", predicted.fitted, predicted.predicted),
       fmt::format("resonance {:+.2g} %, damping {:+.2g} %, waveform within {:.3g} % (at worst {:.3g} %)",
                   100 * predicted.resonance_error, 100 * predicted.damping_error,
                   100 * predicted.waveform_error, 100 * predicted.worst_waveform_error)});
  results.pictures = tap_pictures(fit);
  return results;
}

}  // namespace tacto::analysis

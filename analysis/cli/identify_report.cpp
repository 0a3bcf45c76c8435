// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/identify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/report/interval_words.hpp"
#include "analysis/identify/report/paper_words.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;

std::string verdict_word(const schema::Identification& found) {
  if (!found.converged) return "DID NOT CONVERGE: playback refuses it without --unfit-transducer";
  return found.misfit ? "MISFIT: playback refuses it without --unfit-transducer" : "fits";
}

void add_head(Report& report, const schema::Transducer& found, const std::string& file) {
  const schema::Identification& about = *found.identification;
  report.add("transducer", file).add("source", about.source);
  if (!about.simulated.empty()) report.add("simulated", about.simulated);
  report.add("conditions", about.conditions).add("verdict", verdict_word(about)).add("because", about.words);
  if (about.usable())
    report.add("next",
               fmt::format("tactograph play TEXTURE -d DEVICE --transducer {}", cli::shell_word(file)));
  else
    report.ends_with(schema::ErrorKind::unsuitable);
}

// tests/analysis/identify_bench_test.py measures these figures.
constexpr const char* kLoadWords =
    "the load on the tray during this measurement has to be that of playback (finger or not). A finger that "
    "is added later reduces accuracy (emulated: -37 to -25 dB instead of -47 to -40 dB)";

void add_loop_rows(Report& report, const LoopFit& fit) {
  report.add("loop_opening_percent", 100 * fit.opening).add("loop_amplitude_v", fit.amplitude_v);
  report.add("lag_degrees", kDegrees * fit.lag_rad)
      .add("lag_of_an_ellipse_degrees", kDegrees * fit.ellipse_lag_rad);
  report.add("gain_of_a_full_swing_m_per_v", fit.gain_m_per_v);
  report.add("left_by_the_operator_percent", 100 * fit.residual_part)
      .add("left_by_a_line_percent", 100 * fit.linear_residual_part);
  std::vector<Report> rows;
  const auto& weights = fit.hysteresis.weights;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) continue;
    Report row;
    row.add("threshold_v", fit.hysteresis.thresholds_v[i]).add("weight", weights[i]);
    rows.push_back(std::move(row));
  }
  const std::size_t zeros = weights.size() - rows.size();
  report.add("operator", std::move(rows));
  if (zeros > 0) report.add("further_weights_of_0", zeros);
}

constexpr int kTableDigits = 4;  // of a report's table

// If the table hides an interval, value and limits look equal in it, so the report adds exact figures.
bool table_hides_an_interval(const ResponseFit& fit) {
  return fit.claims_intervals() && std::ranges::any_of(fit.parameters, [](const FittedParameter& p) {
           return !p.held && interval_is_hidden(p, kTableDigits);
         });
}

void add_model(Report& report, const ResponseFit& fit) {
  report.add("model", name_of(fit.choice));
  if (!fit.choice_words.empty()) report.add("choice", fit.choice_words);
  std::vector<Report> rows;
  for (const TriedModel& model : fit.tried) {
    Report row;
    row.add("model", model.name).add("parameters", model.parameters);
    row.add("left_out_error_percent", 100 * model.left_out);
    if (fit.data.noise_is_measured()) row.add("left_out_error_over_noise", model.left_out_over_noise);
    row.add("converged", model.converged);
    if (model.converged) row.add("misfit", model.misfit);
    rows.push_back(std::move(row));
  }
  if (!rows.empty()) report.add("tried", std::move(rows));
}

std::vector<Report> parameter_rows(const ResponseFit& fit) {
  std::vector<Report> rows;
  const bool in_full = table_hides_an_interval(fit);
  for (const FittedParameter& p : fit.parameters) {
    Report row;
    row.add("parameter", p.name).add("value", p.value);
    const bool claimed = fit.claims_intervals() && !p.held;
    row.add("low_of_95", claimed ? p.low : std::nan("")).add("high_of_95", claimed ? p.high : std::nan(""));
    row.add("held", p.held);
    if (in_full) row.add("in_full", interval_words(p, true));
    rows.push_back(std::move(row));
  }
  return rows;
}

void add_quality(Report& report, const ResponseFit& fit) {
  report.add("r_squared", fit.r_squared)
      .add("iterations", fit.iterations)
      .add("condition_number", fit.condition);
  if (fit.data.noise_is_measured())
    report.add("reduced_chi_squared", fit.misfit.reduced_chi_squared)
        .add("reduced_chi_squared_limit", fit.misfit.chi_squared_limit);
  report.add("residual_phase_correlation", fit.misfit.phase_correlation)
      .add("residual_amplitude_correlation", fit.misfit.amplitude_correlation)
      .add("residual_correlation_limit", fit.misfit.correlation_limit);
  if (fit.data.third_harmonic) report.add("third_harmonic_percent", 100 * *fit.data.third_harmonic);
  report.add("frequencies", fit.data.size());
}

void add_found(Report& report, const schema::Transducer& found) {
  report.add("mass_kg", found.mass_kg).add("damping_n_s_per_m", found.damping_n_s_per_m);
  report.add("amplifier_resistance_ohm", found.amplifier_resistance_ohm);
  report.add("sensor_resistance_ohm", found.sensor_resistance_ohm);
  report.add("actuator_scale", found.actuator_scale).add("sensor_scale", found.sensor_scale);
}

}  // namespace

void add_paper(Report& report, const schema::Transducer& base, const schema::Transducer& found,
               const ResponseFit& fit) {
  if (!is_the_papers(base)) return;
  const auto figures = paper_figures(found, fit);
  if (!figures) return;
  std::vector<Report> rows;
  for (const PaperFigure& f : *figures) {
    Report row;
    row.add("figure", f.what).add("reported", f.reported).add("by_table_i", f.by_table);
    if (std::isfinite(f.identified)) row.add("identified", f.identified);
    row.add("remark", f.remark);
    rows.push_back(std::move(row));
  }
  report.add("paper_against_itself", std::move(rows));
}

Report response_report(const ResponseFit& fit, const schema::Transducer& base,
                       const schema::Transducer& found, const std::string& file) {
  Report report;
  add_head(report, found, file);
  add_model(report, fit);
  report.add("parameters", parameter_rows(fit));
  std::vector<std::string> held = held_words(fit.choice, base);
  held.insert(held.end(), fit.notes.begin(), fit.notes.end());
  report.add("not_identifiable", std::move(held));
  add_quality(report, fit);
  add_found(report, found);
  return report;
}

Report loop_report(const LoopFit& fit, const schema::Transducer& found, const std::string& file) {
  Report report;
  add_head(report, found, file);
  add_loop_rows(report, fit);
  report.add("r_squared", fit.r_squared);
  return report;
}

Report joint_report(const JointFit& fit, const schema::Transducer& base, const schema::Transducer& found,
                    const std::string& file) {
  Report report = response_report(fit.response, base, found, file);
  report.add("rounds", fit.rounds);
  add_loop_rows(report, fit.loops);
  report.add("load", kLoadWords);
  return report;
}

Report taps_report(const TapsFit& fit, const TapsPrediction& predicted, const schema::Transducer& found,
                   const std::string& file) {
  Report report;
  add_head(report, found, file);
  report.add("resonance_hz", fit.resonance_hz.median).add("resonance_spread_hz", fit.resonance_hz.spread);
  report.add("resonance_standard_deviation_hz", fit.resonance_hz.standard_deviation);
  report.add("lowest_resonance_hz", fit.resonance_hz.least)
      .add("highest_resonance_hz", fit.resonance_hz.most);
  report.add("damping_ratio", fit.damping_ratio.median).add("damping_ratio_spread", fit.damping_ratio.spread);
  report.add("damping_ratio_standard_deviation", fit.damping_ratio.standard_deviation);
  report.add("lowest_damping_ratio", fit.damping_ratio.least)
      .add("highest_damping_ratio", fit.damping_ratio.most)
      .add("r_squared", fit.r_squared);
  report.add("fitted_taps", predicted.fitted).add("predicted_taps", predicted.predicted);
  report.add("predicted_resonance_error_percent", 100 * predicted.resonance_error)
      .add("predicted_damping_error_percent", 100 * predicted.damping_error)
      .add("predicted_waveform_error_percent", 100 * predicted.waveform_error)
      .add("shape_error_percent", 100 * predicted.shape_error)
      .add("predicted_waveform_worst_percent", 100 * predicted.worst_waveform_error);
  std::vector<Report> rows;
  for (const RingingTap& tap : fit.taps) {
    Report row;
    row.add("tap", tap.name).add("resonance_hz", tap.modes.front().frequency_hz);
    row.add("damping_ratio", tap.modes.front().damping_ratio);
    row.add("energy_percent", 100 * tap.modes.front().energy_part).add("left_percent", 100 * tap.left);
    rows.push_back(std::move(row));
  }
  report.add("taps", std::move(rows));
  return report;
}

}  // namespace tacto::analysis

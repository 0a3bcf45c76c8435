// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/cli/identify_options.hpp"
#include "analysis/cli/stopped.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/fit/plausibility.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/record_response.hpp"
#include "analysis/identify/report/bode_figure.hpp"
#include "analysis/identify/report/identification.hpp"
#include "analysis/identify/report/identify_results.hpp"
#include "analysis/identify/report/paper_words.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/terminal.hpp"
#include "playback/player/player_device.hpp"
#include "spatial/picture/line_plot.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

// The reports of `identify`.

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

// If `base` is the paper's transducer: its contradictions together with the measured values.
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

// Each function gives the report of one kind of identification; `file` is the written file.
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

constexpr const char* kUsualBase = "wiertlewski2011";

void declare_source(CLI::App& app, IdentifyOptions& o) {
  app.add_option("FILE", o.file,
                 "A response (frequency_hz,amplitude_um_per_v,phase_deg, and if known noise_um_per_v), loops "
                 "(drive_v,displacement_um), taps, or a recording with both channels");
  app.add_option("-d,--device", o.device_uri, "Device: usb:, sim:tray_sensor=on ...");
  app.add_option("-o,--output", o.stem,
                 "Output, required except with --method contact: NAME.transducer.json");
  app.add_option("--start-from", o.base,
                 "Preset or file that the fit starts from; parameters that are not separately identifiable "
                 "keep its values");
  app.add_option("--picture", o.picture, "Bode plot, or the loops: .svg or .png");
  app.add_option(
      "--results", o.results,
      "Also write the results for 'report': NAME.results.json, parameters with intervals and curves");
  cli::add_choice<IdentifyMethod>(
      app, "--method", o.method,
      {{"joint", IdentifyMethod::joint},
       {"sweep", IdentifyMethod::sweep},
       {"multisine", IdentifyMethod::multisine},
       {"chirp", IdentifyMethod::chirp},
       {"loop", IdentifyMethod::loop},
       {"taps", IdentifyMethod::taps},
       {"contact", IdentifyMethod::contact}},
      "Method. joint: a sine at each frequency and slow loops, fitted together, with the load that is on the "
      "tray (a finger that is added later reduces accuracy); sweep, multisine, chirp (nine times 1 s): only "
      "the linear model; loop: only the hysteresis; taps: a sensor's ringing; contact: the "
      "peak force of taps on a surface, from a table with a row for each tap (velocity_mps, peak_n, and if "
      "known acceleration_mps2, grip_n), or the pulses of their force over time");
}

void declare_model(CLI::App& app, IdentifyOptions& o) {
  app.add_flag(
      "--second-mode", o.model.second_mode,
      "The model is one mode and a second resonance with its anti-resonance. Default: the model with the "
      "smallest error on frequencies left out of the fit, of one mode, a second one, a delay, a "
      "reconstruction filter, their combinations, and a lag");
  app.add_flag(
      "--lag", o.model.lag,
      "The model lags by the same angle at all frequencies, for a hysteresis. On a device: of a sweep "
      "alone");
  app.add_flag("--finger", o.model.finger,
               "A finger rests on the tray of a known transducer (--start-from): find its stiffness, damping "
               "and mass");
  app.add_flag("--implausible", o.implausible, "Accept a gain or a resonance far from that of --start-from");
  cli::declare_force(app, o.existing);
}

void declare_measuring(CLI::App& app, IdentifyOptions& o) {
  cli::add_quantity(app, "--amplitude", o.amplitude_v, Dimension::voltage,
                    "Peak of the drive; default: 1V with joint (a fifth of the loops' peak), else 0.5V. The "
                    "loops go up to the limits; with --method loop this is their peak");
  cli::add_quantity(app, "--low", o.plan.low_hz, Dimension::frequency, "Lowest frequency");
  cli::add_quantity(app, "--high", o.high_hz, Dimension::frequency,
                    "Highest frequency; default: 1kHz, and on a device at most 0.45 of its rate");
  app.add_option("--frequencies", o.plan.frequencies, "Number of frequencies, evenly spaced by octaves")
      ->check(cli::from_one());
  cli::add_quantity(app, "--rate", o.rate_hz, Dimension::frequency,
                    "Sample rate of taps, or of loops without a time column");
  app.add_option("--fit-on", o.taps_fitted,
                 "Of taps: number of first taps to fit; they predict the others; default: half")
      ->check(cli::from_one());
}

void declare_tables(CLI::App& app, IdentifyOptions& o) {
  app.add_option("--amplitude-unit", o.units.amplitude,
                 "Unit of the amplitude if the header has none: um/V, V/N, \"dB m/V\"");
  app.add_option("--phase-unit", o.units.phase, "Unit of the phase if the header has none: deg or rad");
  app.add_option("--phase-sign", o.phase_sign, "-1: the table's lags are positive")
      ->check(CLI::IsMember({-1, 1}));
  app.add_flag("--invert", o.invert, "The response was measured with inverted sign");
  app.add_option("--input", o.input,
                 "Input channel of a recording; for a sensor that of a fast reference cell, applied_force");
  app.add_option("--output-channel", o.output,
                 "Output channel of a recording; tangential_force for a sensor");
}

Result<schema::Transducer> base_of(const IdentifyOptions& o, const firmware_host::Device* device) {
  if (!o.base.empty()) return schema::read_transducer(o.base);
  if (device != nullptr && device->capabilities().transducer) return *device->capabilities().transducer;
  return schema::read_transducer(kUsualBase);
}

Result<void> check_band(const IdentifyOptions& o) {
  constexpr std::size_t kMostFrequencies = 1000;
  if (o.plan.frequencies < kLeastFrequencies || o.plan.frequencies > kMostFrequencies)
    return fail(ErrorKind::usage,
                fmt::format("a sweep has {} to {} frequencies", kLeastFrequencies, kMostFrequencies),
                "--frequencies", fmt::format("the default is {}", ExcitationPlan{}.frequencies));
  if (!(o.plan.low_hz > 0 && o.plan.low_hz < o.plan.high_hz))
    return fail(ErrorKind::usage, "the lowest frequency has to be above 0 and below the highest",
                "--low and --high", "the defaults are 10Hz and 1kHz");
  if (o.amplitude_v && !(*o.amplitude_v > 0))
    return fail(ErrorKind::usage, "the drive has to be above 0 V", "--amplitude", "the default is 0.5V");
  return {};
}

Result<IdentifySource> source_of(const IdentifyOptions& o) {
  if (o.file.empty() == o.device_uri.empty())
    return fail(ErrorKind::usage, "name either a file or a device", "identify",
                "-d sim:tray_sensor=on, or FILE");
  TACTO_TRY(check_band(o));
  if (o.model.finger && (o.model.second_mode || o.base.empty()))
    return fail(ErrorKind::usage, "a finger's load can be found on a known transducer only", "--finger",
                "name it with --start-from; its second mode is taken from there");
  IdentifySource asked;
  if (!o.device_uri.empty()) {
    auto opened = playback::open_player_device(o.device_uri, std::nullopt);
    TACTO_TRY(opened);
    asked.device = std::move(*opened);
  }
  auto base = base_of(o, asked.device.device.get());
  TACTO_TRY(base);
  asked.base = std::move(*base);
  return asked;
}

bool is_table(const std::string& file) {
  return file.ends_with(".csv") || file.ends_with(".txt") || file.ends_with(".tsv");
}

Result<BodeData> recorded_response(const IdentifyOptions& o) {
  auto pair = read_recorded_pair(o.file, o.input, o.output);
  TACTO_TRY(pair);
  auto data =
      response_of_record(pair->input, pair->output, pair->rate_hz, o.plan.low_hz, o.plan.high_hz, o.file);
  if (!data) return data;
  data->direction = pair->direction;
  data->simulated = pair->simulated;
  data->conditions = "recorded " + o.input + " and " + o.output;
  return data;
}

Result<BodeData> tabled_response(const IdentifyOptions& o) {
  const auto bode = is_bode_table(o.file);
  TACTO_TRY(bode);
  if (*bode) return read_bode_table(o.file, o.units);
  const auto tray = read_driven_table(o.file);
  TACTO_TRY(tray);
  const double rate_hz = tray->rate_hz > 0 ? tray->rate_hz : o.rate_hz.value_or(0);
  if (!(rate_hz > 0))
    return fail(ErrorKind::usage, "the sample rate is not known", o.file, "give --rate, or a column time_s");
  return response_of_record(tray->drive_v, tray->displacement_m, rate_hz, o.plan.low_hz, o.plan.high_hz,
                            o.file);
}

Result<BodeData> response_of(const IdentifyOptions& o, IdentifySource& asked) {
  if (asked.has_device()) {
    const cli::StopSignals signals;
    cli::Progress progress("identifying");
    firmware_host::Device& device = *asked.device.device;
    auto measured = measured_on(
        device, o.method == IdentifyMethod::joint ? IdentifyMethod::sweep : o.method,
        plan_on(o, device, o.plan.amplitude_v), asked.base, [&] { return signals.stop_asked(); },
        [&](double part) { progress.update(part); });
    asked.stopped = signals.stop_asked();
    return measured;
  }
  auto data = is_table(o.file) ? tabled_response(o) : recorded_response(o);
  if (!data) return data;
  for (auto& value : data->response)
    value = (o.invert ? -1.0 : 1.0) * (o.phase_sign < 0 ? std::conj(value) : value);
  if (data->conditions.empty()) data->conditions = "measured elsewhere";
  return data;
}

Result<Report> identify_response(const IdentifyOptions& o, IdentifySource& asked) {
  auto data = response_of(o, asked);
  TACTO_TRY(data);
  ModelChoice choice = o.model;
  choice.direction = data->direction;
  const auto sound = check_measured(*data, choice, asked.base, {o.phase_sign < 0, o.invert});
  TACTO_TRY(sound);
  const ResponseFit fit = fit_response(*data, choice, asked.base);
  TACTO_TRY(check_fitted(o, fit, asked.base));
  const schema::Transducer found = identified(fit, asked.base, transducer_name_of(o));
  TACTO_TRY(schema::write_transducer(o.stem, found));
  Report report = response_report(fit, asked.base, found, transducer_file_of(o));
  if (!o.base.empty()) add_paper(report, asked.base, found, fit);
  TACTO_TRY(draw_identified(o, BodeFigure(fit), report));
  return with_identify_results(
      o, [&] { return identify_results(fit, asked.base, found); }, std::move(report));
}

Result<Report> identify_taps(const IdentifyOptions& o, const IdentifySource& asked) {
  if (!o.picture.empty())
    return fail(ErrorKind::usage, "taps have no picture", "--picture", "omit it; the table lists each tap");
  if (o.file.empty() || !o.rate_hz)
    return fail(ErrorKind::usage, "taps come from a table and need its rate", "--method taps",
                "identify taps.csv --rate 100kHz");
  const auto taps = read_taps(o.file, *o.rate_hz);
  TACTO_TRY(taps);
  const auto fit = fit_taps(*taps);
  TACTO_TRY(fit);
  const std::size_t fitted = o.taps_fitted > 0 ? o.taps_fitted : taps->taps.size() / 2;
  if (fitted < 2 || fitted + 2 > taps->taps.size())
    return fail(ErrorKind::usage, "at least two taps have to be fitted, and two predicted", "--fit-on",
                "the default is half of them");
  const auto predicted = predict_taps(*taps, fitted);
  TACTO_TRY(predicted);
  schema::Identification about;
  about.source = o.file;
  about.conditions = "ringing after taps";
  const schema::Transducer found = identified(*fit, asked.base, transducer_name_of(o), about);
  TACTO_TRY(schema::write_transducer(o.stem, found));
  Report report = taps_report(*fit, *predicted, found, transducer_file_of(o));
  return with_identify_results(
      o, [&] { return identify_results(*fit, *predicted, found); }, std::move(report));
}

constexpr double kSweepPart = 0.75;  // share of the total measuring time

std::string loops_words(double amplitude_v) {
  return "loops of " + schema::for_people(amplitude_v, Dimension::voltage) + " at 1 Hz";
}

Result<DrivenTray> driven_loops(const IdentifyOptions& o, IdentifySource& source,
                                schema::Identification& about) {
  firmware_host::Device& device = *source.device.device;
  const double amplitude_v = o.amplitude_v.value_or(loop_amplitude_v(source.base));
  about.source = device.capabilities().uri;
  about.simulated = device.capabilities().simulated_device;
  about.conditions = loops_words(amplitude_v);
  const cli::StopSignals signals;
  cli::Progress progress("identifying");
  auto tray = drive_tray(
      device, slow_loops(drive_rate_hz(device), amplitude_v), [&] { return signals.stop_asked(); },
      [&](double part) { progress.update(part); });
  source.stopped = signals.stop_asked();
  return tray;
}

Result<DrivenTray> loops_of(const IdentifyOptions& o, IdentifySource& source, schema::Identification& about) {
  if (source.has_device()) return driven_loops(o, source, about);
  about.source = o.file;
  auto tray = read_driven_table(o.file);
  if (tray && !(tray->rate_hz > 0)) tray->rate_hz = o.rate_hz.value_or(0);
  if (tray && o.invert)
    for (double& value : tray->displacement_m) value = -value;
  return tray;
}

void warn_of_limits(const char* what, std::size_t limited) {
  if (limited == 0) return;
  cli::warn(
      fmt::format("the device limited {} ticks of the {}: the fit uses the limited drive; a smaller "
                  "--amplitude avoids this",
                  limited, what));
}

struct SweepAndLoops {
  DrivenResponse sweep;
  DrivenTray loops;
};

// The sweep has the requested amplitude, the loops the largest that the limits allow.
Result<SweepAndLoops> measured_both(const IdentifyOptions& o, IdentifySource& source) {
  firmware_host::Device& device = *source.device.device;
  const cli::StopSignals signals;
  cli::Progress progress("identifying");
  const auto stop_asked = [&] { return signals.stop_asked(); };
  const ExcitationPlan plan = plan_on(o, device, joint_amplitude_v(o.plan, source.base));
  const double amplitude_v = loop_amplitude_v(source.base);
  auto sweep = driven_response(device, IdentifyMethod::sweep, plan, source.base, stop_asked,
                               [&](double part) { progress.update(kSweepPart * part); });
  source.stopped = signals.stop_asked();
  TACTO_TRY(sweep);
  auto loops = drive_tray(device, slow_loops(plan.rate_hz, amplitude_v, plan.amplitude_v), stop_asked,
                          [&](double part) { progress.update(kSweepPart + (1 - kSweepPart) * part); });
  source.stopped = signals.stop_asked();
  TACTO_TRY(loops);
  sweep->data.conditions += ", and " + loops_words(amplitude_v);
  return SweepAndLoops{std::move(*sweep), std::move(*loops)};
}

Result<JointFit> joint_fit_of(const IdentifyOptions& o, SweepAndLoops& both, const schema::Transducer& base) {
  BodeData& data = both.sweep.data;
  TACTO_TRY(check_measured(data, o.model, base, {}));
  auto fit = fit_jointly(data, both.sweep.drive, both.loops, o.model, base);
  if (!fit) return fit;
  TACTO_TRY(check_upright(fit->loops, data.source));
  TACTO_TRY(check_fitted(o, fit->response, base));
  return fit;
}

constexpr double kMicrometresAMetre = 1e6;

spatial::Series loop_series(const char* name, const LoopFit& fit, const std::vector<double>& displacement_m,
                            std::size_t colour) {
  spatial::Series series{name, fit.loop_v, displacement_m, spatial::series_colour(colour)};
  for (double& value : series.y) value *= kMicrometresAMetre;
  return series;
}

// Displacement over drive, without the linear model's lag. `found` is the resulting transducer.
spatial::LineFigure loop_figure(const LoopFit& fit, const schema::Transducer& found) {
  spatial::LineFigure figure;
  figure.title = found.identification->usable() ? "Hysteresis" : "Hysteresis: THE MODEL DOES NOT FIT";
  figure.subtitle = fmt::format(
      "a loop of {:.3g} %; the operator leaves {:.2g} % of the displacement, a line "
      "{:.3g} %",
      100 * fit.opening, 100 * fit.residual_part, 100 * fit.linear_residual_part);
  figure.x_label = "drive (V)";
  figure.y_label = "displacement (\u00b5m)";
  figure.simulated = found.identification->simulated;
  figure.series = {loop_series("measured", fit, fit.loop_m, 0),
                   loop_series("operator", fit, fit.loop_model_m, 1)};
  figure.series[1].dashed = true;
  figure.size = {480, 440};
  return figure;
}

// Identifies the hysteresis alone, from a device or a table.
Result<Report> identify_loops(const IdentifyOptions& o, IdentifySource& source) {
  schema::Identification about;
  about.conditions = "loops measured elsewhere";
  const auto tray = loops_of(o, source, about);
  TACTO_TRY(tray);
  if (!(tray->rate_hz > 0))
    cli::warn("no rate is known: the linear model's own lag is counted as hysteresis");
  warn_of_limits("loops", tray->limited);
  const double held_s = source.has_device() ? 0.5 / tray->rate_hz : 0;
  const auto fit = fit_loops(tray->drive_v, tray->displacement_m, tray->rate_hz,
                             delay_at_rest_s(source.base) + held_s, source.base.drive_limit_v);
  TACTO_TRY(fit);
  TACTO_TRY(check_upright(*fit, about.source, o.invert));
  TACTO_TRY(o.implausible ? Result<void>() : check_size(*fit, source.base, about.source));
  const schema::Transducer found = identified(*fit, source.base, transducer_name_of(o), about);
  TACTO_TRY(schema::write_transducer(o.stem, found));
  Report report = loop_report(*fit, found, transducer_file_of(o));
  TACTO_TRY(draw_identified(o, loop_figure(*fit, found), report));
  return with_identify_results(
      o, [&] { return identify_results(*fit, found); }, std::move(report));
}

// Measures a sweep and slow loops on a device and fits them together.
Result<Report> identify_jointly(const IdentifyOptions& o, IdentifySource& source) {
  auto both = measured_both(o, source);
  TACTO_TRY(both);
  warn_of_limits("sweep", both->sweep.data.limited);
  warn_of_limits("loops", both->loops.limited);
  const auto fit = joint_fit_of(o, *both, source.base);
  TACTO_TRY(fit);
  const schema::Transducer found = identified(*fit, source.base, transducer_name_of(o));
  TACTO_TRY(schema::write_transducer(o.stem, found));
  Report report = joint_report(*fit, source.base, found, transducer_file_of(o));
  if (!o.base.empty()) add_paper(report, source.base, found, fit->response);
  TACTO_TRY(draw_identified(o, BodeFigure(fit->response), report));
  return with_identify_results(
      o, [&] { return identify_results(*fit, source.base, found); }, std::move(report));
}

Result<Report> identify_by(const IdentifyOptions& o, IdentifySource& asked) {
  if (o.method == IdentifyMethod::taps) return identify_taps(o, asked);
  if (o.method == IdentifyMethod::loop) return identify_loops(o, asked);
  if (o.method == IdentifyMethod::joint && asked.has_device() && !o.model.lag)
    return identify_jointly(o, asked);
  return identify_response(o, asked);
}

// Checks the names before the measurement, so that its result is not lost to a name that is taken.
Result<void> check_names_free(const IdentifyOptions& o) {
  for (const std::string& path : {transducer_file_of(o), o.picture})
    if (auto free = schema::check_output_free(path, o.existing); !free) return free;
  if (o.results.empty()) return {};
  if (o.results.ends_with(".json")) return schema::check_results_free(o.results, o.existing);
  return fail(ErrorKind::usage, "has an ending that this verb does not write", o.results,
              "name results (NAME.results.json)");
}

// Two outputs of the same name would overwrite each other.
schema::Result<void> check_apart(const std::vector<std::string>& files) {
  for (auto file = files.begin(); file != files.end(); ++file)
    if (!file->empty() && std::any_of(files.begin(), file, [&](const auto& other) {
          return !other.empty() && schema::same_file(*file, other);
        }))
      return schema::fail(schema::ErrorKind::usage, "is named twice", *file,
                          "give transducer, picture and results different names");
  return {};
}

// Errors: usage: the transducer file has no name (the message suggests one, made from the name of the
// results or the picture), or two of the three names are the same file.
schema::Result<void> check_named(const std::string& stem, const std::string& results,
                                 const std::string& picture) {
  if (!stem.empty())
    return check_apart({schema::stem_of(stem, ".transducer") + ".transducer.json", picture, results});
  std::string name = "NAME", beside;
  if (!picture.empty()) {
    name = picture.substr(0, picture.rfind('.'));
    beside = fmt::format("; --picture {} is drawn beside it", picture);
  }
  if (!results.empty()) {
    name = schema::stem_of(results, ".results");
    beside = fmt::format("; --results {} is written beside it", results);
  }
  return schema::fail(schema::ErrorKind::usage,
                      "the transducer file, which identify always writes, has no name", "--output",
                      fmt::format("add -o {} for {}.transducer.json{}", name, name, beside));
}

// --method contact describes taps and writes no file.
Result<void> check_contact_options(const CLI::App& app) {
  constexpr std::string_view kUsed[] = {"FILE", "device", "method", "rate",    "fit-on",
                                        "help", "json",   "rows",   "progress"};
  for (const CLI::Option* option : app.get_options())
    if (option->count() > 0 && std::ranges::find(kUsed, option->get_single_name()) == std::end(kUsed))
      return fail(ErrorKind::usage,
                  "has no use with --method contact, which describes taps and writes no file",
                  "--" + option->get_single_name(), "omit it; --json prints everything for programs");
  return {};
}

Result<Report> run_identify(const IdentifyOptions& o) {
  if (o.method == IdentifyMethod::contact) return identify_contact(o);
  TACTO_TRY(check_named(o.stem, o.results, o.picture));
  TACTO_TRY(check_names_free(o));
  auto asked = source_of(o);
  TACTO_TRY(asked);
  auto report = identify_by(o, *asked);
  const bool stopped = !report && asked->stopped;
  asked->device = {};
  if (stopped) end_as_stopped();
  return report;
}

cli::Action declare_identify(CLI::App& app) {
  auto options = std::make_shared<IdentifyOptions>();
  declare_source(app, *options);
  declare_model(app, *options);
  declare_measuring(app, *options);
  declare_tables(app, *options);
  return [options, &app]() -> Result<Report> {
    if (options->method == IdentifyMethod::contact) TACTO_TRY(check_contact_options(app));
    options->plan.high_hz = options->high_hz.value_or(options->plan.high_hz);
    ModelChoice& model = options->model;
    model.open = !(model.second_mode || model.lag || model.finger);
    return run_identify(*options);
  };
}

}  // namespace

const cli::Verb kIdentifyVerb{
    "identify", "Find a transducer's parameters, with their uncertainty, from a device or measured data",
    "tactograph identify -d sim:tray_sensor=on,hysteresis=0.16 -o bench --picture bench.svg --results "
    "bench.results.json\n"
    "  tactograph identify -d sim:tray_sensor=on,hysteresis=0.16,second_mode=800Hz,finger_load=on -o loaded\n"
    "  tactograph identify response.csv --start-from wiertlewski2011 -o mine\n"
    "  tactograph record -d sim:force=chirp,force_amplitude=30mN -o pull --time 8s\n"
    "  tactograph identify pull --input applied_force --output-channel tangential_force -o sensor\n"
    "  tactograph identify impacts.csv --method taps --rate 100kHz -o sensor\n"
    "  tactograph identify taps.csv --method contact",
    declare_identify};

}  // namespace tacto::analysis

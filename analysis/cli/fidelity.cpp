// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "analysis/cli/results_output.hpp"
#include "analysis/cli/stopped.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/fidelity/fidelity_page.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/warnings.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::Result;

struct FidelityVerbOptions {
  FidelityOptions fidelity;
  std::vector<std::string> speeds = {"50mm/s"}, outputs;
  schema::Existing existing = schema::Existing::keep;
};

// The limits that explain the row's error: they removed as much, or at most 6 dB less.
std::string limits_behind(const FidelitySpeed& speed, const FidelityRow& row) {
  constexpr double kLessDb = 6;
  if (!speed.removed_db || *speed.removed_db < row.error_db - kLessDb) return "no limit";
  if (speed.slew_limited == 0) return "drive limit";
  return speed.amplitude_limited == 0 ? "slew limit" : "drive and slew limit";
}

Report tray_row(const FidelitySpeed& speed, const FidelityRow& row, bool simulated) {
  Report report;
  if (speed.speed_mps > 0) report.add("speed_mps", speed.speed_mps);
  report.add("tray", row.tray).add("error_db", row.error_db).add("error_in_place_db", row.error_in_place_db);
  report.add("limited_by", limits_behind(speed, row));
  if (row.rerecorded_db) report.add("rerecorded_db", *row.rerecorded_db);
  report.add("shift_m", row.shift_m).add("level_db", row.level_db);
  report.add("target_rms_m", row.target_rms_m).add("displacement_rms_m", row.finger_rms_m);
  return report.add("displacement", simulated ? "simulated" : "modelled");
}

Report taken_row(const FidelitySpeed& speed) {
  Report report;
  if (speed.speed_mps > 0) report.add("speed_mps", speed.speed_mps);
  report.add("low_hz", speed.low_hz).add("high_hz", speed.high_hz);
  report.add("band_kept_percent", speed.band_kept_percent).add("drive_peak_v", speed.drive_peak_v);
  report.add("drive_limit_v", speed.drive_limit_v).add("ticks", speed.ticks);
  report.add("amplitude_limited_ticks", speed.amplitude_limited)
      .add("slew_limited_ticks", speed.slew_limited);
  if (speed.removed_db && *speed.removed_db > -300) report.add("removed_db", *speed.removed_db);
  return report.add("delay_left_s", speed.delay_left_s).add("inverse_error_db", speed.inverse_error_db);
}

Report fidelity_report(const Fidelity& fidelity) {
  Report report;
  report.add("texture", fidelity.texture).add("device", fidelity.device);
  if (!fidelity.simulated.empty()) report.add("simulated", fidelity.simulated);
  report.add("displacement", fidelity.displacement).add("gain_m_per_n", fidelity.gain_m_per_n);
  report.add("rate_hz", fidelity.rate_hz);
  std::vector<Report> rows, taken;
  for (const FidelitySpeed& speed : fidelity.speeds) {
    taken.push_back(taken_row(speed));
    for (const FidelityRow& row : speed.rows)
      rows.push_back(tray_row(speed, row, !fidelity.simulated.empty()));
  }
  return report.add("fidelity", std::move(rows)).add("lost", std::move(taken));
}

schema::Results fidelity_results(const Fidelity& fidelity) {
  schema::Results results;
  results.verb = "fidelity";
  results.inputs = {fidelity.texture};
  results.device = fidelity.device;
  results.simulated = fidelity.simulated;
  results.figures = fidelity_figures(fidelity);
  results.pictures = fidelity_pictures(fidelity);
  return results;
}

// Keeps empty items, so that a list that ends in a comma is detected.
std::vector<std::string> between_commas(const std::vector<std::string>& lists) {
  std::vector<std::string> pieces;
  for (const std::string& list : lists) {
    pieces.emplace_back();
    for (const char c : list)
      if (c == ',')
        pieces.emplace_back();
      else
        pieces.back() += c;
  }
  return pieces;
}

Result<void> read_speeds(FidelityVerbOptions& o) {
  o.fidelity.speeds_mps.clear();
  for (const std::string& text : between_commas(o.speeds)) {
    if (text.empty())
      return schema::fail(schema::ErrorKind::usage, "a speed beside a comma is missing", "--speed",
                          "give one, or several separated by commas: 25mm/s,100mm/s");
    const auto speed = schema::parse_quantity(text, Dimension::speed);
    if (!speed)
      return schema::fail(schema::ErrorKind::usage, speed.error().what, "--speed " + text,
                          speed.error().remedy);
    o.fidelity.speeds_mps.push_back(*speed);
  }
  return {};
}

Result<Fidelity> found_until_stopped(FidelityVerbOptions& o, bool& stopped) {
  const cli::StopSignals signals;
  cli::Progress progress("fidelity");
  o.fidelity.stop_asked = [&] { return signals.stop_asked(); };
  auto found = fidelity(o.fidelity, [&](double part) { progress.update(part); });
  stopped = signals.stop_asked();
  return found;
}

Result<Report> run_fidelity(FidelityVerbOptions o) {
  TACTO_TRY(check_outputs(o.outputs, o.existing));
  TACTO_TRY(read_speeds(o));
  bool stopped = false;
  const auto found = found_until_stopped(o, stopped);
  if (!found && stopped) end_as_stopped();
  TACTO_TRY(found);
  std::vector<std::string> notes;
  for (const FidelitySpeed& speed : found->speeds)
    notes.insert(notes.end(), speed.notes.begin(), speed.notes.end());
  cli::warn_grouped(notes);
  Report report = fidelity_report(*found);
  const auto written = write_outputs(o.outputs, o.existing, fidelity_results(*found), report,
                                     [&] { return fidelity_page(*found); });
  TACTO_TRY(written);
  if (!o.outputs.empty()) report.add("written", o.outputs);
  return report;
}

cli::Action declare_fidelity(CLI::App& app) {
  auto options = std::make_shared<FidelityVerbOptions>();
  playback::PlayOptions& play = options->fidelity.play;
  play.device_uri = "sim:";
  app.add_option("TEXTURE", play.program.file, "Texture of force: stem or file name")->required();
  app.add_option("-d,--device", play.device_uri, "Device: sim:, sim:hysteresis=0.16 ..., usb:")
      ->capture_default_str();
  app.add_option("--transducer", play.transducer,
                 "The model that is inverted: a preset or NAME.transducer.json; default: the device's own");
  app.add_option("--speed", options->speeds,
                 "Speed of an emulated finger: one, or several separated by commas");
  cli::add_quantity(app, "--time", play.time_s, Dimension::time, "Duration on a real device [10 s]");
  cli::add_gain(app, play.program.gain, "Gain: ", "; default: the gain in the texture's file, or 1mm/N");
  cli::declare_unfit_transducer(app, play.program.unfit_transducer);
  cli::add_quantity(app, "--rate", play.prepare.rate_hz, Dimension::frequency, "Tick rate of the drive");
  app.add_option("-o,--output,--page", options->outputs,
                 "Output: a page (.html) or results for 'report' (.results.json); may be repeated");
  cli::declare_force(app, options->existing);
  app.footer(app.get_footer() +
             "\nThe error is the RMS of displacement minus target, in dB of the target's RMS, after the "
             "constant shift "
             "along the texture that makes it smallest. In place: without that shift. Re-recorded: of the "
             "displacement "
             "as a sensor with noise measures it (emulated trays only).");
  return [options] { return run_fidelity(*options); };
}

}  // namespace

const cli::Verb kFidelityVerb{"fidelity",
                              "Play a texture on a device and compare the tray's displacement with the "
                              "target: one error per tray and speed",
                              "tactograph fidelity oak -o oak-fidelity.html\n  tactograph fidelity oak -d "
                              "sim:hysteresis=0.16 --speed 25mm/s,100mm/s",
                              declare_fidelity};

}  // namespace tacto::analysis

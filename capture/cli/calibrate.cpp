// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "capture/cli/calibrate_parts.hpp"
#include "capture/cli/verbs.hpp"
#include "capture/import/plausibility.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::capture {
namespace {

constexpr cli::VerbPart kWays[] = {
    {"tare", "Without any contact: offset, noise floor and mains of each force channel", declare_tare},
    {"force", "Force scale: by known weights on a load cell, or of the piezo against a load cell",
     declare_force},
    {"encoder", "Position scale, by a known travel", declare_encoder},
};

cli::Action declare_calibrate(CLI::App& app) {
  return cli::declare_parts(app, kWays);
}

schema::Result<void> check_scales(const std::vector<schema::CalibrationEntry>& entries, bool only_warn) {
  for (const schema::CalibrationEntry& entry : entries) {
    const std::string doubt = scale_fault(entry);
    if (doubt.empty()) continue;
    if (!only_warn)
      return schema::fail(schema::ErrorKind::unsuitable, doubt + ": not stored", entry.method,
                          "check for a wrong unit or two exchanged weights with --dry-run; store it "
                          "nevertheless with --anyway");
    cli::warn(doubt);
  }
  return {};
}

}  // namespace

const cli::Verb kCalibrateVerb{
    "calibrate", "Measure a device's offsets, scales and noise, and store them for its recordings",
    "tactograph calibrate tare\n"
    "  tactograph calibrate force --mass 0g --mass 100g --mass 200g\n"
    "  tactograph calibrate force --reference net_force --time 20s\n"
    "  tactograph calibrate encoder --travel 50mm --repeats 6\n"
    "  tactograph calibrate force --channel net_force --mass 0g=empty --mass 100g=loaded@1s..3s",
    declare_calibrate};

void declare_common(CLI::App& app, CalibrateOptions& options) {
  app.add_option("-d,--device", options.device, "The device: usb:, usb:serial=XYZ, comedi:NAME, sim:...");
  app.add_option("--calibration", options.calibration,
                 "Calibration file; default: SERIAL.calibration.json in ~/.config/tactograph/calibrations");
  app.add_flag("--dry-run", options.dry_run, "Measure and print only; store nothing");
  app.add_flag("--anyway", options.anyway,
               "Store it even if it is implausible: movement in a tare, a scale above twice or below half "
               "the nominal one, or uncertain by more than 20 %");
  app.fallthrough();
}

cli::Report report_on(const Take& take) {
  cli::Report report;
  report.add("device", take.header.device).add("serial", take.header.serial);
  if (!take.header.simulated.empty()) report.add("simulated", take.header.simulated);
  return report;
}

void add_scale(cli::Report& report, const Uncertain& scale, double own_scale, const std::string& unit) {
  const double relative = std::abs(scale.uncertainty / scale.value);
  report.add("scale", scale.value).add("scale_unit", unit + " per stored number");
  report.add("of_the_devices_own", scale.value / own_scale);
  report.add("standard_uncertainty_percent", 100 * relative);
  report.add("interval_of_95_percent", 100 * relative * coverage_factor_95(scale.degrees_of_freedom));
}

schema::Result<cli::Report> kept(cli::Report report, const CalibrateOptions& options, const Take& take,
                                 std::vector<schema::CalibrationEntry> entries) {
  TACTO_TRY(check_scales(entries, options.dry_run || options.anyway));
  if (options.dry_run) return report;
  const std::string now = schema::creation_time();
  const auto path =
      keep_calibration(take.header, take.device_name, std::move(entries), options.calibration, now);
  TACTO_TRY(path);
  report.add("date", now).add("file", *path);
  return report.add("next", "tactograph record -d " + cli::shell_word(take.header.device) + " -o oak");
}

}  // namespace tacto::capture

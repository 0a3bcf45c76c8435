// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/doctor/doctor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "capture/cli/verbs.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/wiring/wiring.hpp"

namespace tacto::capture {
namespace {

constexpr std::string_view kComedi = "comedi:";

struct DoctorOptions {
  DoctorRequest request;
  std::optional<double> stale_after_s;
};

const char* to_string(Health health) {
  constexpr const char* kWords[] = {"works", "warning", "FAILS", "skipped"};
  return kWords[static_cast<std::size_t>(health)];
}

cli::Report row_of(const Check& check) {
  cli::Report row;
  row.add("check", check.name).add("state", to_string(check.health)).add("found", check.found);
  return row.add("what_to_do", check.remedy);
}

// The card's input of a channel, and the sensor's range there.
cli::Report row_of(const schema::Channel& channel) {
  cli::Report row;
  row.add("channel", channel.name).add("from", channel.source);
  return row.add("unit", channel.unit).add("smallest", *channel.range_min).add("largest", *channel.range_max);
}

schema::Result<cli::Report> run_doctor(const DoctorOptions& options) {
  DoctorRequest request = options.request;
  request.stale_after_s = options.stale_after_s.value_or(kStaleAfter_s);
  const Diagnosis diagnosis = examine(request);
  std::vector<cli::Report> rows;
  // A short terminal shows the first rows only.
  std::vector<Check> checks = diagnosis.checks;
  std::ranges::stable_partition(checks, [](const Check& check) { return check.health == Health::fails; });
  for (const Check& check : checks) rows.push_back(row_of(check));
  const Check* const first_failure = diagnosis.first_failure();
  cli::Report report;
  report.add("checks", std::move(rows));
  std::vector<cli::Report> wired;
  for (const schema::Channel& channel : diagnosis.channels)
    if (options.request.device.starts_with(kComedi)) wired.push_back(row_of(channel));
  if (!wired.empty()) {
    report.add("wiring", std::move(wired));
    const auto wiring = schema::read_wiring(options.request.device.substr(kComedi.size()));
    if (wiring)
      for (auto& [what, from] : schema::wired_for_playback(*wiring)) report.add(what, std::move(from));
  }
  report.add("can_record", first_failure == nullptr).add("next", diagnosis.next);
  if (first_failure != nullptr)
    report.ends_with(first_failure->name == "disk" ? first_failure->fault : schema::ErrorKind::device);
  return report;
}

cli::Action declare_doctor(CLI::App& app) {
  auto options = std::make_shared<DoctorOptions>();
  DoctorRequest& request = options->request;
  app.add_option("-d,--device", request.device,
                 "The device: usb:, usb:serial=XYZ, tty:, comedi:NAME, sim:...");
  app.add_option("-o,--folder", request.folder, "Folder of the recordings");
  app.add_option("--calibration", request.calibration,
                 "Calibration file of the device, if not the one that 'tactograph calibrate' stores");
  cli::add_quantity(
      app, "--stale-after", options->stale_after_s, schema::Dimension::time,
      "Age from which a calibration is stale; default: " + fmt::format("{} days", kStaleAfterDays));
  app.add_option("--questions", request.questions, "Number of measured round trips to the device");
  app.footer(app.get_footer() +
             "\nExit code 0: a recording can be made; 7: the folder or the disk prevents it; 8: another "
             "cause prevents it.");
  return [options] { return run_doctor(*options); };
}

}  // namespace

const cli::Verb kDoctorVerb{
    "doctor", "Check what a recording needs: device, permission, limits, disk, calibration",
    "tactograph doctor\n  tactograph doctor -d sim:surface=C -o /data/study-3 --json", declare_doctor};

}  // namespace tacto::capture

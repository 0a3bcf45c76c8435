// SPDX-License-Identifier: GPL-3.0-or-later
// Force devices, and the hands on them.
#include "data-schema/cli/describe.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"

namespace tacto::schema {
namespace {

cli::Report row_of(const DeviceAxis& axis) {
  cli::Report row;
  row.add("axis", axis.name).add("mass_kg", axis.mass_kg);
  row.add("viscous_n_s_per_m", axis.viscous_n_s_per_m).add("coulomb_n", axis.coulomb_n);
  row.add("encoder_step_m", axis.encoder_step_m);
  row.add("travel_from_m", axis.travel_from_m).add("travel_to_m", axis.travel_to_m);
  row.add("peak_force_n", axis.peak_force_n).add("continuous_force_n", axis.continuous_force_n);
  return row;
}

std::vector<cli::Report> rate_rows(const Device& device) {
  std::vector<cli::Report> rows;
  for (const double rate_hz : device.rates_hz) rows.push_back(cli::Report().add("rate_hz", rate_hz));
  return rows;
}

}  // namespace

Result<cli::Report> describe_device(const std::string& path) {
  const auto device = read_device(path);
  TACTO_TRY(device);
  warn_of_unknown(path, *device);
  cli::Report report = report_of(FileKind::device, path, "");
  report.add("name", device->name);
  std::vector<cli::Report> axes;
  for (const DeviceAxis& axis : device->axes) axes.push_back(row_of(axis));
  report.add("axes", std::move(axes));
  report.add("peak_force_n", device->peak_force_n).add("continuous_force_n", device->continuous_force_n);
  report.add("slew_n_per_s", device->slew_n_per_s).add("delay_s", device->delay_s);
  report.add("rates", rate_rows(*device));
  add_text(report, "transducer", device->transducer);
  add_text(report, "source", device->source);
  add_text(report, "notes", device->notes);
  return report;
}

Result<cli::Report> describe_hand(const std::string& path) {
  const auto hand = read_hand(path);
  TACTO_TRY(hand);
  warn_of_unknown(path, *hand);
  cli::Report report = report_of(FileKind::hand, path, "");
  report.add("name", hand->name).add("mass_kg", hand->mass_kg);
  report.add("damping_n_s_per_m", hand->damping_n_s_per_m);
  report.add("stiffness_n_per_m", hand->stiffness_n_per_m);
  add_text(report, "source", hand->source);
  add_text(report, "notes", hand->notes);
  return report;
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// Force devices, and the hands on them.
#include <fmt/format.h>

#include <cmath>

#include "data-schema/base/quantity.hpp"
#include "data-schema/calibration/calibration.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/wiring/wiring.hpp"

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

// For a zero, which is a stored number, also its value in the channel's unit: by the entry's own scale, or
// the device's if it has none.
void add_zero(cli::Report& row, const CalibrationEntry& entry) {
  if (!entry.zero) return;
  const double scale = entry.scale.value_or(entry.nominal_scale);
  row.add("zero_as_stored", *entry.zero).add(key_in("zero", entry.unit), *entry.zero * scale);
  if (entry.zero_uncertainty)
    row.add(key_in("zero_uncertainty", entry.unit), std::abs(*entry.zero_uncertainty * scale));
}

cli::Report row_of(const CalibrationEntry& entry) {
  cli::Report row;
  row.add("channel", entry.channel).add("method", entry.method).add("date", entry.date);
  if (entry.scale) row.add("scale", *entry.scale).add("of_nominal", *entry.scale / entry.nominal_scale);
  if (entry.scale && entry.scale_uncertainty)
    row.add("uncertainty_percent", 100 * std::abs(*entry.scale_uncertainty / *entry.scale));
  add_zero(row, entry);
  row.add("unit", entry.unit);
  if (!entry.notes.empty()) row.add("notes", entry.notes);
  return row;
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

Result<cli::Report> describe_wiring(const std::string& path) {
  const auto wiring = read_wiring(path);
  TACTO_TRY(wiring);
  warn_of_unknown(path, *wiring);
  cli::Report report = report_of(FileKind::wiring, path, "");
  report.add("name", wiring->name).add("card", wiring->card).add("rate_hz", wiring->rate_hz);
  std::vector<cli::Report> inputs;
  for (const WiredInput& input : wiring->inputs) {
    cli::Report row;
    row.add("input", input.input).add("channel", input.name).add("reference", input.reference);
    row.add("range_from_v", input.range_from_v).add("range_to_v", input.range_to_v);
    const auto unit = si_symbol(quantity_named(input.quantity)->dimension);
    const std::string at_zero =
        input.at_zero_volt == 0 ? "" : fmt::format(", {:g} {} at 0 V", input.at_zero_volt, unit);
    row.add("sensor", input.per_volt ? fmt::format("{:g} {}/V{}", *input.per_volt, unit, at_zero)
                                     : wiring->transducer_name + ", its output voltage");
    inputs.push_back(std::move(row));
  }
  report.add("inputs", std::move(inputs));
  add_text(report, "notes", wiring->notes);
  return report;
}

Result<cli::Report> describe_calibration(const std::string& path) {
  const auto file = read_calibration(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::calibration, path, file->simulated);
  report.add("serial", file->serial);
  add_text(report, "device", file->device);
  std::vector<cli::Report> rows;
  for (const CalibrationEntry& entry : file->entries) rows.push_back(row_of(entry));
  return report.add("entries", std::move(rows));
}

}  // namespace tacto::schema

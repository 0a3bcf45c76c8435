// SPDX-License-Identifier: GPL-3.0-or-later
// Force devices and the hands on them, wirings of cards, calibrations, transducers.
#include <fmt/format.h>

#include <cmath>

#include "data-schema/base/quantity.hpp"
#include "data-schema/calibration/calibration.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/transducer/transducer_plausible.hpp"
#include "data-schema/wiring/wiring.hpp"

namespace tacto::schema {
namespace {

using cli::Report;

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

void add_limits(Report& report, const Transducer& t) {
  report.add("drive_limit_v", t.drive_limit_v).add("displacement_limit_m", t.displacement_limit_m);
  report.add("slew_limit_v_per_s", t.slew_limit_v_per_s);
}

void add_derived(Report& report, const Transducer& t) {
  report.add("resonance_hz", resonance_hz(t)).add("damping_ratio", damping_ratio(t));
  report.add("sensor_pole_hz", sensor_pole_hz(t)).add("actuator_pole_hz", actuator_pole_hz(t));
  report.add("actuator_gain_at_0hz_m_per_v", std::abs(actuator_response(t, 0)));
  report.add("sensor_gain_at_100hz_v_per_n", std::abs(sensor_response(t, 100)));
  report.add("nominal_n_per_v", nominal_newtons_per_volt(t));
}

void add_mechanics(Report& report, const Transducer& t) {
  report.add("deflection_m", t.deflection_m).add("max_voltage_v", t.max_voltage_v);
  report.add("bender_stiffness_n_per_m", t.bender_stiffness_n_per_m);
  report.add("flexure_stiffness_n_per_m", t.flexure_stiffness_n_per_m);
  report.add("mass_kg", t.mass_kg).add("damping_n_s_per_m", t.damping_n_s_per_m);
}

void add_electronics(Report& report, const Transducer& t) {
  report.add("capacitance_f", t.capacitance_f).add("sensor_gain", t.sensor_gain);
  report.add("sensor_resistance_ohm", t.sensor_resistance_ohm).add("amplifier_gain", t.amplifier_gain);
  report.add("amplifier_resistance_ohm", t.amplifier_resistance_ohm);
  report.add("sensor_scale", t.sensor_scale).add("actuator_scale", t.actuator_scale);
  report.add("converter_bits", t.converter_bits).add("converter_range_v", t.converter_range_v);
  report.add("noise_n_per_sqrt_hz", t.noise_n_per_sqrt_hz);
}

void add_extras(Report& report, const Transducer& t) {
  if (t.hysteresis) report.add("hysteresis_thresholds", t.hysteresis->thresholds_v.size());
  if (t.reconstruction_cutoff_hz) report.add("reconstruction_cutoff_hz", *t.reconstruction_cutoff_hz);
  if (!t.second_mode) return;
  report.add("second_mode_hz", t.second_mode->frequency_hz);
  report.add("second_mode_damping_ratio", t.second_mode->damping_ratio);
  report.add("second_mode_zero_hz", t.second_mode->zero_hz);
}

void add_identification(Report& report, const Transducer& t) {
  if (!t.identification) return;
  const Identification& found = *t.identification;
  report.add("identified", found.date).add("identified_from", found.source);
  report.add("identification_usable", found.usable()).add("r_squared", found.r_squared);
  report.add("valid_from_hz", found.low_hz).add("valid_to_hz", found.high_hz);
  add_text(report, "identification_words", found.words);
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
  for (auto& [what, from] : wired_for_playback(*wiring)) report.add(what, std::move(from));
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

Result<Report> describe_transducer(const std::string& path) {
  const auto transducer = read_transducer(path, Numbers::computable);
  TACTO_TRY(transducer);
  if (const auto plausible = check_plausible(*transducer, path); !plausible)
    cli::warn(message(plausible.error()));
  warn_of_unknown(path, *transducer);
  Report report = report_of(FileKind::transducer, path, "");
  report.add("name", transducer->name);
  add_limits(report, *transducer);
  add_derived(report, *transducer);
  add_mechanics(report, *transducer);
  add_electronics(report, *transducer);
  add_extras(report, *transducer);
  add_identification(report, *transducer);
  add_text(report, "origin", transducer->origin);
  return report;
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/transducer/transducer_plausible.hpp"

namespace tacto::schema {
namespace {

using cli::Report;

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

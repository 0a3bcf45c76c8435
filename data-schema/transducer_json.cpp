// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/transducer_json.hpp"

#include "data-schema/json_document.hpp"

namespace tacto::schema {
namespace {

struct Parameter {
  const char* name;
  double Transducer::*member;
};

constexpr Parameter kParameters[] = {
    {"deflection_m", &Transducer::deflection_m},
    {"max_voltage_v", &Transducer::max_voltage_v},
    {"bender_stiffness_n_per_m", &Transducer::bender_stiffness_n_per_m},
    {"flexure_stiffness_n_per_m", &Transducer::flexure_stiffness_n_per_m},
    {"mass_kg", &Transducer::mass_kg},
    {"damping_n_s_per_m", &Transducer::damping_n_s_per_m},
    {"capacitance_f", &Transducer::capacitance_f},
    {"sensor_gain", &Transducer::sensor_gain},
    {"sensor_resistance_ohm", &Transducer::sensor_resistance_ohm},
    {"amplifier_gain", &Transducer::amplifier_gain},
    {"amplifier_resistance_ohm", &Transducer::amplifier_resistance_ohm},
    {"sensor_scale", &Transducer::sensor_scale},
    {"actuator_scale", &Transducer::actuator_scale},
    {"converter_range_v", &Transducer::converter_range_v},
    {"noise_n_per_sqrt_hz", &Transducer::noise_n_per_sqrt_hz},
    {"drive_limit_v", &Transducer::drive_limit_v},
    {"displacement_limit_m", &Transducer::displacement_limit_m},
    {"slew_limit_v_per_s", &Transducer::slew_limit_v_per_s},
};

}  // namespace

Json transducer_body(const Transducer& transducer) {
  Json body = Json::object();
  put_text(body, "name", transducer.name);
  for (const auto& [name, member] : kParameters) body[name] = transducer.*member;
  body["converter_bits"] = transducer.converter_bits;
  put_text(body, "origin", transducer.origin);
  return body;
}

Transducer transducer_from(const Json& body) {
  Transducer transducer;
  transducer.name = text_or(body, "name");
  for (const auto& [name, member] : kParameters)
    transducer.*member = number_or(body, name, transducer.*member);
  transducer.converter_bits = static_cast<int>(number_or(body, "converter_bits", transducer.converter_bits));
  transducer.origin = text_or(body, "origin");
  return transducer;
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/transducer/transducer_json.hpp"

#include "data-schema/json/json_document.hpp"

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

Json hysteresis_body(const Hysteresis& hysteresis) {
  return {{"thresholds_v", hysteresis.thresholds_v}, {"weights", hysteresis.weights}};
}

Json second_mode_body(const ModeAbove& mode) {
  return {{"frequency_hz", mode.frequency_hz},
          {"damping_ratio", mode.damping_ratio},
          {"zero_hz", mode.zero_hz},
          {"zero_damping_ratio", mode.zero_damping_ratio}};
}

Json identification_body(const Identification& found) {
  Json body = {{"date", found.date}, {"source", found.source}};
  put_text(body, "conditions", found.conditions);
  put_text(body, "simulated", found.simulated);
  body["converged"] = found.converged;
  body["misfit"] = found.misfit;
  put_text(body, "words", found.words);
  body["r_squared"] = found.r_squared;
  body["low_hz"] = found.low_hz;
  body["high_hz"] = found.high_hz;
  return body;
}

Hysteresis hysteresis_from(const Json& body) {
  return {body["thresholds_v"].get<std::vector<double>>(), body["weights"].get<std::vector<double>>()};
}

ModeAbove second_mode_from(const Json& body) {
  return {body["frequency_hz"], body["damping_ratio"], body["zero_hz"], body["zero_damping_ratio"]};
}

Identification identification_from(const Json& body) {
  Identification found;
  found.date = body["date"];
  found.conditions = text_or(body, "conditions");
  found.source = body["source"];
  found.simulated = text_or(body, "simulated");
  found.converged = body["converged"];
  found.misfit = body["misfit"];
  found.words = text_or(body, "words");
  found.r_squared = body["r_squared"];
  found.low_hz = body["low_hz"];
  found.high_hz = body["high_hz"];
  return found;
}

}  // namespace

Json transducer_body(const Transducer& transducer) {
  Json body = Json::object();
  put_text(body, "name", transducer.name);
  for (const auto& [name, member] : kParameters) body[name] = transducer.*member;
  body["converter_bits"] = transducer.converter_bits;
  put_text(body, "origin", transducer.origin);
  if (transducer.hysteresis) body["hysteresis"] = hysteresis_body(*transducer.hysteresis);
  if (transducer.second_mode) body["second_mode"] = second_mode_body(*transducer.second_mode);
  if (transducer.reconstruction_cutoff_hz)
    body["reconstruction_cutoff_hz"] = *transducer.reconstruction_cutoff_hz;
  if (transducer.identification) body["identification"] = identification_body(*transducer.identification);
  return body;
}

Transducer transducer_from(const Json& body) {
  Transducer transducer;
  transducer.name = text_or(body, "name");
  for (const auto& [name, member] : kParameters)
    transducer.*member = number_or(body, name, transducer.*member);
  transducer.converter_bits = static_cast<int>(number_or(body, "converter_bits", transducer.converter_bits));
  transducer.origin = text_or(body, "origin");
  if (body.contains("hysteresis")) transducer.hysteresis = hysteresis_from(body["hysteresis"]);
  if (body.contains("second_mode")) transducer.second_mode = second_mode_from(body["second_mode"]);
  if (body.contains("reconstruction_cutoff_hz"))
    transducer.reconstruction_cutoff_hz = body["reconstruction_cutoff_hz"].get<double>();
  if (body.contains("identification"))
    transducer.identification = identification_from(body["identification"]);
  return transducer;
}

}  // namespace tacto::schema

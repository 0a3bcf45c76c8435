// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {
namespace {

using Complex = std::complex<double>;

Complex laplace(double frequency_hz) {
  return {0.0, 2 * std::numbers::pi * frequency_hz};
}

double stiffness(const Transducer& t) {
  return t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
}

// m s^2 + b_r s + k_r + k_p, N/m: both directions share the mechanics.
Complex mechanics(const Transducer& t, Complex s) {
  return t.mass_kg * s * s + t.damping_n_s_per_m * s + stiffness(t);
}

Complex quadratic(double frequency_hz, double damping_ratio, Complex s) {
  const Complex p = s / (2 * std::numbers::pi * frequency_hz);
  return p * p + 2 * damping_ratio * p + 1.0;
}

// m/N, with a second mode where there is one.
Complex compliance(const Transducer& t, Complex s) {
  const Complex first = 1.0 / mechanics(t, s);
  if (!t.second_mode) return first;
  const ModeAbove& mode = *t.second_mode;
  return first * quadratic(mode.zero_hz, mode.zero_damping_ratio, s) /
         quadratic(mode.frequency_hz, mode.damping_ratio, s);
}

// Two layers of C_p in parallel behind a resistor.
Complex electrics(double resistance_ohm, double capacitance_f, Complex s) {
  return 1.0 + 2.0 * resistance_ohm * capacitance_f * s;
}

double pole_hz(double resistance_ohm, double capacitance_f) {
  return 1 / (4 * std::numbers::pi * resistance_ohm * capacitance_f);
}

constexpr double kNominalHz = 100;  // where the sensor's response is flattest

}  // namespace

double piezo_coefficient_m_per_v(const Transducer& transducer) {
  return transducer.deflection_m / (2 * transducer.max_voltage_v);
}

Complex sensor_response(const Transducer& t, double frequency_hz) {
  const Complex s = laplace(frequency_hz);
  const double size = 2 * t.sensor_gain * t.sensor_resistance_ohm * t.bender_stiffness_n_per_m *
                      piezo_coefficient_m_per_v(t) * t.sensor_scale;
  return -size * s / (electrics(t.sensor_resistance_ohm, t.capacitance_f, s) * mechanics(t, s));
}

Complex actuator_response(const Transducer& t, double frequency_hz) {
  const Complex s = laplace(frequency_hz);
  const double size = 2 * piezo_coefficient_m_per_v(t) * t.bender_stiffness_n_per_m * t.amplifier_gain;
  const Complex filter = t.reconstruction_cutoff_hz
                             ? butterworth3_response(*t.reconstruction_cutoff_hz, frequency_hz)
                             : Complex(1);
  return size * t.actuator_scale * filter * compliance(t, s) /
         electrics(t.amplifier_resistance_ohm, t.capacitance_f, s);
}

Complex butterworth3_response(double cutoff_hz, double frequency_hz) {
  const Complex s(0.0, frequency_hz / cutoff_hz);
  return 1.0 / ((s + 1.0) * (s * s + s + 1.0));
}

double nominal_newtons_per_volt(const Transducer& transducer) {
  return 1 / sensor_response(transducer, kNominalHz).real();
}

double resonance_hz(const Transducer& transducer) {
  return std::sqrt(stiffness(transducer) / transducer.mass_kg) / (2 * std::numbers::pi);
}

double damping_ratio(const Transducer& transducer) {
  return transducer.damping_n_s_per_m / (2 * std::sqrt(stiffness(transducer) * transducer.mass_kg));
}

double sensor_pole_hz(const Transducer& transducer) {
  return pole_hz(transducer.sensor_resistance_ohm, transducer.capacitance_f);
}

double actuator_pole_hz(const Transducer& transducer) {
  return pole_hz(transducer.amplifier_resistance_ohm, transducer.capacitance_f);
}

}  // namespace tacto::schema

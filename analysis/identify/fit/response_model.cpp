// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/response_model.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/identify/measure/angles.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;

double stiffness_of(const schema::Transducer& t) {
  return t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
}

constexpr double kMostCutoff = 5;    // times the band's end; a higher cutoff is a delay
constexpr double kHighestMode = 10;  // times the band's end

// 1 - r^2 + 2 i damping r.
Complex resonator(double frequency_hz, double resonance_hz, double damping) {
  const double r = frequency_hz / resonance_hz;
  return {1 - r * r, 2 * damping * r};
}

// 2 G_s R_s k_p beta w_pole / k: the sensor's gain in V/N far above its pole and far below resonance.
double sensor_gain_of(const schema::Transducer& t) {
  return 2 * t.sensor_gain * t.sensor_resistance_ohm * t.bender_stiffness_n_per_m *
         schema::piezo_coefficient_m_per_v(t) * t.sensor_scale * kTurn * schema::sensor_pole_hz(t) /
         stiffness_of(t);
}

double gain_of(const schema::Transducer& t, Direction direction) {
  return direction == Direction::actuator ? std::abs(schema::actuator_response(t, 0)) : sensor_gain_of(t);
}

double pole_of(const schema::Transducer& t, Direction direction) {
  return direction == Direction::actuator ? schema::actuator_pole_hz(t) : schema::sensor_pole_hz(t);
}

void add_finger(std::vector<ModelParameter>& list) {  // starts: FingerLoad, from Wiertlewski, Hayward 2012
  list.push_back({"added_stiffness_n_per_m", true, 1, 1e6, 1e3});
  list.push_back({"added_damping_n_s_per_m", true, 1e-4, 1e3, 1.8});
  list.push_back({"added_mass_kg", true, 1e-7, 0.1, 1e-4});
}

void add_tray(std::vector<ModelParameter>& list, const schema::Transducer& base, Direction direction,
              double low_hz, double high_hz) {
  const bool actuator = direction == Direction::actuator;
  const double gain = gain_of(base, direction);
  list.push_back({actuator ? "gain_m_per_v" : "gain_v_per_n", true, 1e-9 * gain, 1e9 * gain, gain});
  list.push_back({"resonance_hz", true, low_hz / 3, 5 * high_hz, schema::resonance_hz(base)});
  list.push_back({"damping_ratio", true, 1e-5, 100, schema::damping_ratio(base)});
  list.push_back({"pole_hz", true, low_hz / 100, 1e3 * high_hz, pole_of(base, direction)});
}

void add_second_mode(std::vector<ModelParameter>& list, double low_hz, double high_hz) {
  list.push_back({"second_mode_hz", true, low_hz, kHighestMode * high_hz, std::sqrt(low_hz * high_hz)});
  list.push_back({"second_mode_damping_ratio", true, 1e-5, 3, 0.03});
  list.push_back({"second_mode_zero_hz", true, low_hz, kHighestMode * high_hz, std::sqrt(low_hz * high_hz)});
  list.push_back({"second_mode_zero_damping_ratio", true, 1e-5, 3, 0.03});
}

}  // namespace

std::string name_of(const ModelChoice& choice) {
  if (choice.finger) return "finger";
  std::string name;
  for (const Extension& one : kExtensions)
    if (choice.*one.has) name += (name.empty() ? "" : ", ") + std::string(one.name);
  return name.empty() ? "one mode" : name;
}

double ModelParameter::coordinate(double value) const {
  return logarithmic ? std::log(value) : value;
}

double ModelParameter::value(double coordinate) const {
  return logarithmic ? std::exp(coordinate) : coordinate;
}

ResponseModel::ResponseModel(const ModelChoice& choice, const schema::Transducer& base, const BodeData& data)
    : choice_(choice), base_(base) {
  const double low_hz = data.frequency_hz.front(), high_hz = data.frequency_hz.back();
  if (choice.finger) add_finger(parameters_);
  if (!choice.finger) add_tray(parameters_, base, choice.direction, low_hz, high_hz);
  if (choice.second_mode) add_second_mode(parameters_, low_hz, high_hz);
  const double most_ms = 1e3 * kMostDelayPeriods / high_hz;
  if (choice.delay) parameters_.push_back({"delay_ms", false, -most_ms, most_ms, 0});
  if (choice.filter)
    parameters_.push_back({"reconstruction_cutoff_hz", true, low_hz, kMostCutoff * high_hz, high_hz});
  if (choice.lag) parameters_.push_back({"lag_rad", false, -1.5, 1.5, 0});
  delay_ = place_of("delay_ms"), filter_ = place_of("reconstruction_cutoff_hz"), lag_ = place_of("lag_rad");
  for (ModelParameter& parameter : parameters_) {
    parameter.base = parameter.start;
    parameter.start = std::clamp(parameter.start, 1.01 * parameter.low, 0.99 * parameter.high);
  }
}

std::size_t ResponseModel::place_of(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::find(parameters_, name, &ModelParameter::name) -
                                  parameters_.begin());
}

Complex ResponseModel::loaded(std::span<const double> v, double hz) const {
  const Complex s(0, kTurn * hz);
  const Complex tray = base_.mass_kg * s * s + base_.damping_n_s_per_m * s + stiffness_of(base_);
  const Complex added = v[2] * s * s + v[1] * s + v[0];
  const Complex free = choice_.direction == Direction::actuator ? schema::actuator_response(base_, hz)
                                                                : schema::sensor_response(base_, hz);
  return free * tray / (tray + added);
}

Complex ResponseModel::at(std::span<const double> v, double hz) const {
  if (choice_.finger) return loaded(v, hz);
  const Complex pole(1, hz / v[kPole]);
  Complex below = pole * resonator(hz, v[kResonance], v[kDamping]);
  Complex above = v[kGain];
  if (choice_.direction == Direction::sensor) above *= Complex(0, -hz / v[kPole]);
  if (choice_.second_mode) {
    above *= resonator(hz, v[kSecondMode + 2], v[kSecondMode + 3]);
    below *= resonator(hz, v[kSecondMode], v[kSecondMode + 1]);
  }
  if (choice_.delay) above *= std::polar(1.0, -1e-3 * kTurn * hz * v[delay_]);
  if (choice_.filter) above *= schema::butterworth3_response(v[filter_], hz);
  if (choice_.lag) above *= std::polar(1.0, hz < 0 ? v[lag_] : -v[lag_]);
  return above / below;
}

// k_r, k_p, beta, C_p and the amplifiers' gains are held: see held_words().
void ResponseModel::put_tray(std::span<const double> v, schema::Transducer& t) const {
  const double k = stiffness_of(t), w = kTurn * v[kResonance];
  t.mass_kg = k / (w * w);
  t.damping_n_s_per_m = 2 * v[kDamping] * std::sqrt(k * t.mass_kg);
  const double resistance_ohm = 1 / (2 * kTurn * v[kPole] * t.capacitance_f);
  if (choice_.direction == Direction::actuator) t.amplifier_resistance_ohm = resistance_ohm;
  if (choice_.direction == Direction::sensor) t.sensor_resistance_ohm = resistance_ohm;
  double& scale = choice_.direction == Direction::actuator ? t.actuator_scale : t.sensor_scale;
  scale *= v[kGain] / gain_of(t, choice_.direction);
  if (choice_.direction == Direction::sensor) return;
  t.second_mode.reset();
  t.reconstruction_cutoff_hz.reset();
  if (choice_.filter) t.reconstruction_cutoff_hz = v[filter_];
  if (choice_.second_mode)
    t.second_mode =
        schema::ModeAbove{v[kSecondMode], v[kSecondMode + 1], v[kSecondMode + 2], v[kSecondMode + 3]};
}

schema::Transducer ResponseModel::transducer(std::span<const double> v) const {
  schema::Transducer t = base_;
  if (!choice_.finger) {
    put_tray(v, t);
    return t;
  }
  t.flexure_stiffness_n_per_m += v[0];
  t.damping_n_s_per_m += v[1];
  t.mass_kg += v[2];
  return t;
}

}  // namespace tacto::analysis

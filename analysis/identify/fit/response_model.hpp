// SPDX-License-Identifier: GPL-3.0-or-later
// The electromechanical model as a function of the few numbers that a frequency response determines.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// Extensions of the model beyond one mode and the electrical pole.
struct ModelChoice {
  Direction direction = Direction::actuator;
  bool second_mode = false;  ///< a resonance and its anti-resonance (schema::ModeAbove)
  bool lag = false;     ///< a phase lag that is the same at all frequencies: Wiertlewski 2011's hysteresis
  bool finger = false;  ///< instead of the tray's own numbers: stiffness, damping and mass added to them
  bool delay = false;   ///< a pure delay: what a fit lacks is found with it, playback has none
};

/// One number of the model. `coordinate` is its logarithm if `logarithmic`, otherwise the value; fit, bounds
/// and intervals use coordinates.
struct ModelParameter {
  std::string name;  ///< ends in its unit
  bool logarithmic = true;
  double low = 0, high = 0;  ///< bounds of the value
  double start = 0;
  double base = 0;  ///< the base's value, used if the parameter is held

  double coordinate(double value) const;
  double value(double coordinate) const;
};

/// A delay's range, either way: periods of the highest frequency.
inline constexpr int kMostDelayPeriods = 2;

/// actuator: gain / ((1 + i f / pole) (1 - r^2 + 2 i damping r)), r = f / resonance, times the second mode's
/// q(zero) / q(resonance), times exp(-i lag). Wiertlewski 2011, equations (5), (6), in the four numbers that
/// determine a response; the paper's table has nine.
/// sensor: -gain (i f / pole) / (the same two factors). Equation (4).
/// finger: the base's own response with k, b and m added to its mechanics; the base's gain is held.
class ResponseModel {
 public:
  /// Bounds from the range of the frequencies, starting values from the base. Precondition: check_bode(data).
  ResponseModel(const ModelChoice& choice, const schema::Transducer& base, const BodeData& data);

  const ModelChoice& choice() const { return choice_; }
  const std::vector<ModelParameter>& parameters() const { return parameters_; }
  std::vector<ModelParameter>& parameters() { return parameters_; }
  /// The response for values in the order of the parameters.
  std::complex<double> at(std::span<const double> values, double frequency_hz) const;
  /// The base with these values, as for a file. held_words() lists what is held.
  schema::Transducer transducer(std::span<const double> values) const;
  const schema::Transducer& base() const { return base_; }

 private:
  std::complex<double> loaded(std::span<const double> values, double frequency_hz) const;
  void put_tray(std::span<const double> values, schema::Transducer& transducer) const;

  ModelChoice choice_;
  schema::Transducer base_;
  std::vector<ModelParameter> parameters_;
};

/// Order of the parameters: gain, resonance, damping, pole, then the second mode's four, then the lag.
inline constexpr std::size_t kGain = 0, kResonance = 1, kDamping = 2, kPole = 3, kSecondMode = 4;

}  // namespace tacto::analysis

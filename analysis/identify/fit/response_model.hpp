// SPDX-License-Identifier: GPL-3.0-or-later
// The electromechanical model as a function of the few numbers that a frequency response determines.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <string_view>
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
  bool delay = false;   ///< a pure delay, as converters have one; playback does not undo it
  bool filter = false;  ///< a reconstruction filter in front of the bender (schema::butterworth3_response)
  bool open = false;    ///< the extensions are chosen by the data (model_choice.hpp)

  bool operator==(const ModelChoice&) const = default;
};

/// The member of each extension that can be added to a model, its name, and the first of its parameters.
struct Extension {
  const char* name;
  bool ModelChoice::*has;
  const char* parameter;
};
inline constexpr Extension kExtensions[] = {{"second mode", &ModelChoice::second_mode, "second_mode_hz"},
                                            {"delay", &ModelChoice::delay, "delay_ms"},
                                            {"filter", &ModelChoice::filter, "reconstruction_cutoff_hz"},
                                            {"lag", &ModelChoice::lag, "lag_rad"}};

/// "one mode", "second mode, delay" ...
std::string name_of(const ModelChoice& choice);

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
/// q(zero) / q(resonance), the filter, and exp(-i lag - i 2 pi f delay). Wiertlewski 2011, equations (5),
/// (6), in the four numbers that determine a response; the paper's table has nine. sensor: -gain (i f / pole)
/// / (the same two factors). Equation (4). finger: the base's own response with k, b and m added to its
/// mechanics; the base's gain is held.
class ResponseModel {
 public:
  /// Bounds from the range of the frequencies, starting values from the base. Precondition: check_bode(data).
  ResponseModel(const ModelChoice& choice, const schema::Transducer& base, const BodeData& data);

  const ModelChoice& choice() const { return choice_; }
  const std::vector<ModelParameter>& parameters() const { return parameters_; }
  /// Place of a parameter; parameters().size() if the model has none of this name.
  std::size_t place_of(std::string_view name) const;
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
  std::size_t delay_ = 0, filter_ = 0, lag_ = 0;  // places of their parameters
};

/// Order of the parameters: gain, resonance, damping, pole, then the second mode's four, then delay,
/// filter and lag.
inline constexpr std::size_t kGain = 0, kResonance = 1, kDamping = 2, kPole = 3, kSecondMode = 4;

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// The piezo transducer's parameters and its complex frequency response, after Wiertlewski, Lozada and Hayward
// 2011.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A Prandtl-Ishlinskii operator (Kuhnen 2003) in front of the linear model: the model is driven by
///   u = sum_i weights[i] play_{thresholds_v[i]}(v_a),
/// where a play of threshold r follows v_a at a distance of at most r: y <- max(v - r, min(v + r, y)).
/// Volts at the amplifier's input. thresholds_v ascend from 0; weights are as many, none below 0 and the
/// first above 0: so the operator has an inverse of its own kind. `identify` scales the weights so that the
/// swing between +-drive_limit_v ends at +-drive_limit_v (sum_i weights[i] (limit - thresholds_v[i]) =
/// limit): a full swing keeps the linear model's gain, a smaller one has less.
struct Hysteresis {
  std::vector<double> thresholds_v, weights;
};

/// A second mode: a resonance and the anti-resonance that belongs to it multiply the compliance
/// 1 / (m s^2 + b_r s + k) by q(zero) / q(resonance), where q is (s/w)^2 + 2 damping s/w + 1 and w = 2 pi f.
/// The gain at rest stays. Exact for a second mass on a spring and a damper, however it is damped.
struct ModeAbove {
  double frequency_hz = 0, damping_ratio = 0;
  double zero_hz = 0, zero_damping_ratio = 0;  ///< equal to the resonance's: no mode
};

/// How the numbers of a file were found, and their limits.
struct Identification {
  std::string date;        ///< ISO 8601, UTC
  std::string conditions;  ///< load, swing, method ...
  std::string source;      ///< the device or the file
  std::string simulated;   ///< by what, where the device is emulated
  bool converged = false;
  bool misfit = false;  ///< the residuals are not noise: the model is wrong, whatever R^2 is
  std::string words;    ///< the fit's own report
  double r_squared = 0;
  double low_hz = 0, high_hz = 0;  ///< the band in which the numbers are valid

  bool usable() const { return converged && !misfit; }
};

/// Names and symbols are the paper's (Table I, equations 1 to 6). All members are required, except the
/// std::optional ones.
struct Transducer {
  std::string name;
  double deflection_m = 0;               ///< delta, largest unloaded deflection
  double max_voltage_v = 0;              ///< v_max, on one layer
  double bender_stiffness_n_per_m = 0;   ///< k_p
  double flexure_stiffness_n_per_m = 0;  ///< k_r
  double mass_kg = 0;                    ///< m
  double damping_n_s_per_m = 0;          ///< b_r
  double capacitance_f = 0;              ///< C_p, one layer
  double sensor_gain = 0;                ///< G_s
  double sensor_resistance_ohm = 0;      ///< R_s
  double amplifier_gain = 0;             ///< G_a
  double amplifier_resistance_ohm = 0;   ///< R_a
  /// Identified divided by theoretical gain: theory gives the shape of a response, identification its size.
  double sensor_scale = 1;
  double actuator_scale = 1;
  int converter_bits = 16;
  double converter_range_v = 10;    ///< +-
  double noise_n_per_sqrt_hz = 0;   ///< sensor's noise floor, as force
  double drive_limit_v = 0;         ///< |V_a| at the amplifier's input
  double displacement_limit_m = 0;  ///< |X|
  double slew_limit_v_per_s = 0;    ///< |dV_a/dt|
  std::string origin;               ///< paper and equation, identification and date
  std::optional<Hysteresis> hysteresis;
  std::optional<ModeAbove> second_mode;
  /// Cutoff of an analog filter in front of the amplifier (butterworth3_response), as the paper's of 600 Hz.
  std::optional<double> reconstruction_cutoff_hz;
  std::optional<Identification> identification;
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
};

/// beta = delta / (2 v_max), m/V. Equation (2).
double piezo_coefficient_m_per_v(const Transducer& transducer);

/// H_s = -2 G_s R_s k_p beta s / ((1 + 2 R_s C_p s)(m s^2 + b_r s + k_r + k_p)) x sensor_scale, V/N, s = 2 pi
/// i f.
std::complex<double> sensor_response(const Transducer& transducer, double frequency_hz);

/// H_a = 2 beta k_p G_a / ((1 + 2 R_a C_p s)(m s^2 + b_r s + k_r + k_p)) x actuator_scale, m/V. Equations
/// (5), (6): with the factor 2 that the printed H_a lacks; a second mode and a filter multiply it. A
/// hysteresis is not part of it: no transfer function has one.
std::complex<double> actuator_response(const Transducer& transducer, double frequency_hz);

/// Unit-gain analog Butterworth low-pass of order 3, as the paper's reconstruction filter (600 Hz), 1.
std::complex<double> butterworth3_response(double cutoff_hz, double frequency_hz);

/// Newtons per volt of the sensor in its flat middle range, sign included: 1 / Re(H_s) at 100 Hz.
double nominal_newtons_per_volt(const Transducer& transducer);

/// sqrt((k_r + k_p) / m) / 2 pi: the tray's undamped resonance without a finger.
double resonance_hz(const Transducer& transducer);

/// b_r / (2 sqrt((k_r + k_p) m)), 1.
double damping_ratio(const Transducer& transducer);

/// 1 / (4 pi R C_p): the sensor's high-pass (R_s) and the amplifier's low-pass (R_a).
double sensor_pole_hz(const Transducer& transducer);
double actuator_pole_hz(const Transducer& transducer);

/// The names of the transducers that come with tactograph.
std::vector<std::string_view> preset_names();

/// Checks what the schema cannot: that the hysteresis is an operator with an inverse, and that the identified
/// band is increasing. Errors: malformed, in `where`#/field.
Result<void> check_extras(const Transducer& transducer, const std::string& where);

/// Checks whether it may be used for playback. Errors: unsuitable, if its own identification says that it did
/// not converge or that the model is wrong, unless the user accepts it (--unfit-transducer).
Result<void> check_usable(const Transducer& transducer, bool forced);

/// Which numbers a file may contain: those of a possible transducer, or, with --implausible, all numbers
/// that can be computed with (transducer_plausible.hpp).
enum class Numbers { plausible, computable };

/// By preset name, stem or file (NAME.transducer.json). Errors: not_found (with the presets), malformed (also
/// by check_extras), unsupported_version; unsuitable, by check_plausible and check_computable.
Result<Transducer> read_transducer(const std::string& name, Numbers numbers = Numbers::plausible);

/// Errors: cannot_write; malformed: by check_extras.
Result<void> write_transducer(const std::string& stem, const Transducer& transducer);

}  // namespace tacto::schema

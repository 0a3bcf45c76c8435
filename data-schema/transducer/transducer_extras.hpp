// SPDX-License-Identifier: GPL-3.0-or-later
// What a transducer's file may say beyond the paper's Table I: hysteresis, a second mode, how it was
// identified.
#pragma once

#include <string>
#include <vector>

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
  double zero_hz = 0, zero_damping_ratio = 0;  ///< where they equal the resonance's there is no mode
};

/// How the numbers of a file were found, and how far they can be believed.
struct Identification {
  std::string date;        ///< ISO 8601, UTC
  std::string conditions;  ///< load, swing, method ...
  std::string source;      ///< the device or the file
  std::string simulated;   ///< by what, where the device is emulated
  bool converged = false;
  bool misfit = false;  ///< the residuals are not noise: the model is wrong, by whatever R^2
  std::string words;    ///< what the fit said about itself
  double r_squared = 0;
  double low_hz = 0, high_hz = 0;  ///< the numbers are valid from here to here

  bool usable() const { return converged && !misfit; }
};

}  // namespace tacto::schema

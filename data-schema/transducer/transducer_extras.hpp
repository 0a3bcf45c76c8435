// SPDX-License-Identifier: GPL-3.0-or-later
// Optional contents of a transducer's file beyond the paper's Table I: hysteresis, a second mode, how it was
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

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// A hysteresis found from slow loops of drive against displacement.
#pragma once

#include <span>
#include <vector>

#include "analysis/identify/fit/operator_errors.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// What slow loops say. `opening`: the largest loop's height at no drive over its whole height.
struct LoopFit {
  schema::Hysteresis hysteresis;
  double gain_m_per_v = 0;     ///< of the swing between +-amplitude
  double amplitude_v = 0;      ///< of the largest loop
  double opening = 0;          ///< a part, measured
  double lag_rad = 0;          ///< of the fundamental, on the largest loop
  double ellipse_lag_rad = 0;  ///< that an ellipse of this opening would have: asin(opening)
  double r_squared = 0;
  double residual_part = 0;         ///< RMS of what the operator leaves, over the RMS displacement
  double linear_residual_part = 0;  ///< the same of a straight line: what there was to explain
  double loop_hz = 0;               ///< of the largest loop; 0 where no rate is known
  std::vector<double> loop_v, loop_m, loop_model_m;  ///< the largest loop, and what the operator makes of it
  OperatorErrors errors;  ///< of `hysteresis`, scaled as it is; noise and misfit as parts of residual_part
  bool explains_more = false;  ///< the operator explains more than noise would let it, beside a line
  bool usable = false;  ///< the operator leaves at most a third of what the line leaves, or both are small
};

/// Prandtl-Ishlinskii by non-negative least squares: displacement = offset + gain x sum_i w_i
/// play_{r_i}(drive), at the thresholds given, else at kThresholds evenly from 0 to the amplitude. The
/// weights are scaled so that the swing between +-drive_limit_v keeps its size (schema::Hysteresis). The
/// plays begin at the first sample; what comes before the drive has first reached its largest values both
/// ways is not compared. `delay_s` is taken off the drive's time: what the linear model lags at low
/// frequencies, which is no hysteresis. Errors: unsuitable: too few samples, no swing, NaN, a drive that
/// never turns round, or that passes zero so fast that no branch can be seen there.
schema::Result<LoopFit> fit_loops(std::span<const double> drive_v, std::span<const double> displacement_m,
                                  double rate_hz, double delay_s, double drive_limit_v,
                                  std::vector<double> thresholds_v = {});

inline constexpr std::size_t kThresholds = 12;

/// 0; eight evenly up to `fine_v`, where the operator has to be known best; eight evenly from there to below
/// `amplitude_v`. So many playback can undo without merging any (wire::kMaxPlays). Where fine_v is above half
/// of the amplitude: all evenly.
std::vector<double> thresholds_finer_below(double fine_v, double amplitude_v);

/// Of a slow drive: -d(phase) / d(omega) of the actuator at rest, 2 R_a C_p + b_r / (k_r + k_p).
double delay_at_rest_s(const schema::Transducer& transducer);

}  // namespace tacto::analysis

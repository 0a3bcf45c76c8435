// SPDX-License-Identifier: GPL-3.0-or-later
// Fits a hysteresis to slow loops of drive against displacement.
#pragma once

#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// Loops and the fit by play operators, from the first sample with a known state on.
struct FittedOperator {
  std::span<const double> drive_v;  ///< the whole drive
  std::size_t first = 0;            ///< first sample of the fit
  schema::Hysteresis found;         ///< as fitted, not scaled
  std::span<const double> left;     ///< residual of the displacement, from `first` on
};

struct OperatorErrors {
  double noise = 0;   ///< RMS of the part of `left` that neighbouring samples do not share
  double misfit = 0;  ///< RMS of the shared part; 0 if it is not distinguishable from the noise
  /// Changes of the operator along independent directions, one standard error each, in its unit: by the
  /// noise, and by the misfit. Their thresholds are the operator's and those in the middle.
  std::vector<schema::Hysteresis> by_noise, by_misfit;
};

/// The result of a fit to slow loops. `opening`: the largest loop's height at zero drive over its whole
/// height.
struct LoopFit {
  schema::Hysteresis hysteresis;
  double gain_m_per_v = 0;     ///< of the swing between +-amplitude
  double amplitude_v = 0;      ///< of the largest loop
  double opening = 0;          ///< relative, measured
  double lag_rad = 0;          ///< of the fundamental, on the largest loop
  double ellipse_lag_rad = 0;  ///< lag of an ellipse with this opening: asin(opening)
  double r_squared = 0;
  double residual_part = 0;         ///< RMS of the operator's residual over RMS of the displacement
  double linear_residual_part = 0;  ///< the same for a straight line
  double loop_hz = 0;               ///< of the largest loop; 0 if the rate is unknown
  std::vector<double> loop_v, loop_m, loop_model_m;  ///< the largest loop, and the operator's response in it
  OperatorErrors errors;  ///< of `hysteresis`, with its scaling; noise and misfit relative, as residual_part
  bool explains_more = false;  ///< the operator's improvement over a line is larger than noise would cause
  bool usable = false;  ///< the operator's residual is at most a third of the line's, or a hundredth of the
                        ///< loop beyond noise
};

/// Prandtl-Ishlinskii by non-negative least squares: displacement = offset + gain x sum_i w_i
/// play_{r_i}(drive), at the given thresholds, by default at kThresholds evenly from 0 to the amplitude. The
/// weights are scaled so that the swing between +-drive_limit_v keeps its size (schema::Hysteresis). The play
/// operators start at the first sample; samples before the drive has reached its largest values in both
/// directions are not compared. The drive is delayed by `delay_s`, the linear model's lag at low frequencies,
/// which is no hysteresis. Errors: unsuitable: too few samples, no swing, NaN, a drive that never reverses,
/// or that passes zero too fast to determine a branch there.
schema::Result<LoopFit> fit_loops(std::span<const double> drive_v, std::span<const double> displacement_m,
                                  double rate_hz, double delay_s, double drive_limit_v,
                                  std::vector<double> thresholds_v = {});

inline constexpr std::size_t kThresholds = 12;

/// Thresholds: 0; eight evenly up to `fine_v`, where the operator has to be most accurate; eight evenly from
/// there to below `amplitude_v`. Playback can invert this number without merging any (wire::kMaxPlays). If
/// fine_v is above half of the amplitude, all are even.
std::vector<double> thresholds_finer_below(double fine_v, double amplitude_v);

/// For a slow drive: -d(phase) / d(omega) of the actuator at 0 Hz, 2 R_a C_p + b_r / (k_r + k_p).
double delay_at_rest_s(const schema::Transducer& transducer);

}  // namespace tacto::analysis

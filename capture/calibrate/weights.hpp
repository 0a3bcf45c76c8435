// SPDX-License-Identifier: GPL-3.0-or-later
// A force channel's scale and zero from known forces.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"
#include "data-schema/calibration/calibration.hpp"

namespace tacto::capture {

/// Uncertainty of standard gravity if the local value is not given: from 9.780 at the equator to 9.832 at the
/// poles, as a rectangular distribution.
inline constexpr double kGravityUncertainty_mps2 = 0.015;

/// One known force, and the channel's mean under it.
struct Weighing {
  double force_n = 0;
  Uncertain code;  ///< the mean, in stored numbers
};

struct WeighedScale {
  Uncertain scale;  ///< N per stored number
  Uncertain zero;   ///< the stored number without force
  double largest_residual_n = 0;
  std::vector<std::string> notes;
};

/// A straight line code = zero + force / scale, by least squares weighted by 1 / u^2 of each mean.
/// Uncertainty: that of the means, propagated, times the square root of chi^2 / (degrees of freedom) if that
/// is above 1 (Birge 1932); added in quadrature to the relative uncertainty that all forces share (gravity).
/// The degrees of freedom are the number of points minus two if the points' scatter determines the
/// uncertainty, otherwise those of the means. Errors: unsuitable: fewer than two different forces, or codes
/// that do not depend on them.
schema::Result<WeighedScale> scale_by_weights(std::span<const Weighing> weighings,
                                              double relative_force_uncertainty);

/// The mean of a channel at rest. Errors: usage: no such channel; unsuitable: no channel of a static force
/// (the piezo is behind a high-pass; the error names the alternative), clipped, too short, or not at rest.
schema::Result<Weighing> weighing_of(const Take& take, const std::string& channel, double force_n);

}  // namespace tacto::capture

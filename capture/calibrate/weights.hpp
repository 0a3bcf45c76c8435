// SPDX-License-Identifier: GPL-3.0-or-later
// A force channel's scale and zero by known forces.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"
#include "data-schema/calibration/calibration.hpp"

namespace tacto::capture {

/// Standard gravity (CGPM 1901), and how far it may be off where nobody says what it is here: from 9.780 at
/// the equator to 9.832 at the poles, as a rectangle.
inline constexpr double kGravity_mps2 = 9.80665;
inline constexpr double kGravityUncertainty_mps2 = 0.015;

/// One known force, and what the channel showed under it.
struct Weighing {
  double force_n = 0;
  Uncertain code;  ///< the mean, in stored numbers
};

struct WeighedScale {
  Uncertain scale;  ///< N per stored number
  Uncertain zero;   ///< the stored number at no force
  double largest_residual_n = 0;
  std::vector<std::string> notes;
};

/// A straight line code = zero + force / scale, least squares weighted by 1 / u^2 of each mean. Uncertainty:
/// that of the means carried through, times the root of chi^2 over the degrees of freedom where that is above
/// 1 (Birge 1932); with all forces' common relative uncertainty (gravity's) in quadrature. The degrees of
/// freedom are the points' less two where their scatter decides, else the means'. Errors: unsuitable: fewer
/// than two different forces, or codes that do not follow them.
schema::Result<WeighedScale> scale_by_weights(std::span<const Weighing> weighings,
                                              double relative_force_uncertainty);

/// The mean of a channel at rest. Errors: usage: no such channel; unsuitable: no channel of a static force
/// (a piezo's, behind a high-pass, with what to do instead), clipped, too short, or not at rest.
schema::Result<Weighing> weighing_of(const Take& take, const std::string& channel, double force_n);

}  // namespace tacto::capture

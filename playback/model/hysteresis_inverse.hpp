// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse of the bender's hysteresis, tick by tick.
#pragma once

#include <span>
#include <vector>

#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::playback {

/// The inverse, in closed form (Kuhnen 2003), of a Prandtl-Ishlinskii operator with weights w_i at thresholds
/// r_i (r_0 = 0, all w_i >= 0, w_0 > 0): with W_i = w_0 + ... + w_i,
///   r'_i = sum_{j <= i} w_j (r_i - r_j), w'_0 = 1 / W_0, w'_i = -w_i / (W_i W_(i-1)).
/// Exact if both begin at rest. If there are more than kMaxPlays play operators (the one without threshold is
/// not counted), those neighbours whose merging changes W least are merged, at their weighted mean threshold,
/// until kMaxPlays are left.
wire::Hysteresis inverse_of(const schema::Hysteresis& hysteresis);

/// The bender's hysteresis acts on its charge, not on the drive: between the two is the amplifier's low-pass
/// at `pole_hz`, whose input is the drive held for a tick. This section compensates the low-pass, so its
/// input is the charge at the end of the tick: y = (x - a x_-1) / (1 - a), a = exp(-2 pi pole / rate). Exact
/// for a held drive.
wire::Section pole_lead(double pole_hz, double rate_hz);

/// The operator itself, from rest: sum_i weights[i] play_{thresholds_v[i]}(drive_v), volts.
std::vector<double> played_through(const schema::Hysteresis& hysteresis, std::span<const double> drive_v);

/// linear_drive_of() sample by sample, from rest; it keeps its state between calls.
class LinearDrive {
 public:
  LinearDrive(const schema::Hysteresis& hysteresis, double pole_hz, double rate_hz);
  double operator()(double drive_v);

 private:
  schema::Hysteresis hysteresis_;
  std::vector<double> plays_;
  double kept_, charge_v_ = 0, last_v_ = 0;
};

/// The drive with which the linear model moves as a bender with this hysteresis does under `drive_v`, held
/// for a tick each, from rest: charge, its hysteresis, and the drive that gives this charge. Double
/// precision; volts.
std::vector<double> linear_drive_of(const std::vector<double>& drive_v, const schema::Hysteresis& hysteresis,
                                    double pole_hz, double rate_hz);

}  // namespace tacto::playback

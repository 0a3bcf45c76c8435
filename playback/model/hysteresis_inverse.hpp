// SPDX-License-Identifier: GPL-3.0-or-later
// The bender's hysteresis undone, tick by tick.
#pragma once

#include <span>
#include <vector>

#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::playback {

/// The operator that undoes a Prandtl-Ishlinskii operator with weights w_i at thresholds r_i (r_0 = 0, all
/// w_i >= 0, w_0 > 0), in closed form (Kuhnen 2003): with W_i = w_0 + ... + w_i,
///   r'_i = sum_{j <= i} w_j (r_i - r_j), w'_0 = 1 / W_0, w'_i = -w_i / (W_i W_(i-1)).
/// Exact where both begin at rest. Of more than kMaxPlays plays (the one without threshold is not counted)
/// the neighbours that change W least are merged, at their weighted mean threshold, until so many are left.
wire::Hysteresis inverse_of(const schema::Hysteresis& hysteresis);

/// The bender lags what the amplifier has charged it to, not what the amplifier was told: between the two
/// lies its low-pass at `pole_hz`, which holds a tick's drive. This section undoes it, so that what goes into
/// it is the charge at the end of the tick: y = (x - a x_-1) / (1 - a), a = exp(-2 pi pole / rate). Exact for
/// a held drive.
wire::Section pole_lead(double pole_hz, double rate_hz);

/// The operator itself, from rest: sum_i weights[i] play_{thresholds_v[i]}(drive_v), volts.
std::vector<double> played_through(const schema::Hysteresis& hysteresis, std::span<const double> drive_v);

/// linear_drive_of() sample by sample, from rest; its past goes on.
class LinearDrive {
 public:
  LinearDrive(const schema::Hysteresis& hysteresis, double pole_hz, double rate_hz);
  double operator()(double drive_v);

 private:
  schema::Hysteresis hysteresis_;
  std::vector<double> plays_;
  double kept_, charge_v_ = 0, last_v_ = 0;
};

/// The drive that would do to the linear model what `drive_v`, held for a tick each, does to a bender with
/// this hysteresis, from rest: charge, its hysteresis, and the drive that charges so. Double precision;
/// volts.
std::vector<double> linear_drive_of(const std::vector<double>& drive_v, const schema::Hysteresis& hysteresis,
                                    double pole_hz, double rate_hz);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// How well one signal follows another in a band, once one constant delay is taken out.
#pragma once

#include "data-schema/base/signal.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

/// error = came(t + delay) - wanted(t), both kept to the band; RMS over all but `settle_s` at either end.
struct ReplayError {
  double delay_s = 0;  ///< of `came` behind `wanted`: the one that makes the error smallest
  double error_rms = 0;
  double target_rms = 0;
  double error_db = 0;  ///< 20 log10(error_rms / wanted_rms)
};

/// The delay is searched for within +-max_delay_s, to 1e-7 s, as a shift of the spectrum's phase.
/// Preconditions: same rate and length, longer than 2 settle_s; `wanted` is not silent in the band.
ReplayError replay_error(const schema::TimeSignal& came, const schema::TimeSignal& target,
                         const spatial::Band& band, double settle_s, double max_delay_s = 5e-3);

}  // namespace tacto::analysis

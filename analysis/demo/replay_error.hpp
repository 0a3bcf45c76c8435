// SPDX-License-Identifier: GPL-3.0-or-later
// Compares a signal with its target in a band, after one constant delay is removed.
#pragma once

#include "data-schema/base/signal.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

/// error = came(t + delay) - target(t), both signals filtered to the band; RMS without `settle_s` at both
/// ends.
struct ReplayError {
  double delay_s = 0;  ///< of `came` behind `target`, with the smallest error
  double error_rms = 0;
  double target_rms = 0;
  double error_db = 0;  ///< 20 log10(error_rms / target_rms)
};

/// The delay is searched within +-max_delay_s, to 1e-7 s, as a shift of the spectrum's phase. Preconditions:
/// same rate and length, longer than 2 settle_s; `target` has power in the band.
ReplayError replay_error(const schema::TimeSignal& came, const schema::TimeSignal& target,
                         const spatial::Band& band, double settle_s, double max_delay_s = 5e-3);

}  // namespace tacto::analysis

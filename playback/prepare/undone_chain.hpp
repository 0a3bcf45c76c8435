// SPDX-License-Identifier: GPL-3.0-or-later
// The chain as a kernel with these options meets it: over which band it is undone, and how well.
#pragma once

#include "playback/prepare/inverse_filter.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

struct UndoneChain {
  Chain chain;
  spatial::Band band;      ///< that is kept whole; its upper edge falls at rates below 2 kHz
  double stops_at_hz = 0;  ///< beyond, nothing is played
};

/// Hysteresis that the plays undo leaves a pole for a section (hysteresis_inverse.hpp).
UndoneChain undone_chain(const schema::Transducer& transducer, const PrepareOptions& options);

/// Whether plays undo the bender's hysteresis.
bool undoes_hysteresis(const schema::Transducer& transducer, const PrepareOptions& options);

/// The filter that options ask for: inverse, delay_s, inverse_taps.
InverseFilter inverse_of(const UndoneChain& undone, const PrepareOptions& options);

/// The largest |chain filter - exp(-2 pi i f delay)| in the band, every hertz, in amplitude and phase
/// whatever the filter was made for: no sound in the band errs by more, re itself.
double largest_inverse_error(const UndoneChain& undone, const InverseFilter& filter);

}  // namespace tacto::playback

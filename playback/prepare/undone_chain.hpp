// SPDX-License-Identifier: GPL-3.0-or-later
// The chain that the kernel's filters invert with these options: the band of the inversion, and its error.
#pragma once

#include "playback/prepare/inverse_filter.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

struct UndoneChain {
  Chain chain;
  spatial::Band band;      ///< passed unchanged; its upper edge falls at rates below 2 kHz
  double stops_at_hz = 0;  ///< nothing is played beyond it
};

/// If play operators invert the hysteresis, a section compensates the remaining pole
/// (hysteresis_inverse.hpp).
UndoneChain undone_chain(const schema::Transducer& transducer, const PrepareOptions& options);

/// Whether play operators invert the bender's hysteresis.
bool undoes_hysteresis(const schema::Transducer& transducer, const PrepareOptions& options);

/// The filter for the options inverse, delay_s, inverse_taps.
InverseFilter inverse_of(const UndoneChain& undone, const PrepareOptions& options);

/// The largest |chain filter - exp(-2 pi i f delay)| in the band, in steps of 1 Hz, in amplitude and phase
/// for every kind of filter: an upper bound of the relative error of any signal in the band.
double largest_inverse_error(const UndoneChain& undone, const InverseFilter& filter);

}  // namespace tacto::playback

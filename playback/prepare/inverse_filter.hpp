// SPDX-License-Identifier: GPL-3.0-or-later
// The chain undone by a finite filter that runs tick by tick.
#pragma once

#include <vector>

#include "firmware-host/core/wire/message_types.hpp"
#include "playback/model/chain.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

struct InverseDesign {
  double delay_s = 2e-3;      ///< that it may take
  double most_gain_db = 20;   ///< re its gain at rest
  double stops_at_hz = 1250;  ///< beyond, nothing comes in
  std::size_t taps = 0;       ///< 0: as many as usual
};

/// A filter of V for m at the chain's rate, and what it is worth.
struct InverseFilter {
  std::vector<float> taps;
  std::size_t solutions = 0;  ///< least squares solved on the way; 0 of a gain alone
  double delay_s = 0;         ///< that it and the chain have together
  double error_db = 0;        ///< RMS over the band of |chain filter - exp(-2 pi i f delay)|, re 1
  double gain_db = 0;         ///< largest, re the gain at rest, with the chain's lead
  double beyond_band_db = 0;  ///< largest |chain filter| from the band's edge to stops_at_hz or half the rate
};

/// A tenth of what is wanted left over: what an inverse leaves more of is not played.
inline constexpr double kMostInverseErrorDb = -20;

/// full: min sum_f |C g - exp(-2 pi i f d)|^2 over 0 to band.high_hz (a tenth of the weight below
/// band.low_hz), + 1e-6 |C g|^2 beyond, + p(f) |g|^2 there, where p grows by iteration (Lawson) wherever |g|
/// passes most_gain_db (g with the lead that comes behind it, where the chain has one). C is the chain over
/// its gain at rest. Usually 3.2 ms of taps, 24 at least, 128 at most. On the paper's transducer, 2 kHz to 20
/// kHz, 2 ms: error below -69 dB; with its 600 Hz filter below -55 dB. magnitude: the same with |C| for C, so
/// the chain's phase stays; gain, none: one tap, no delay. `error_db` counts, of magnitude, the amplitude
/// alone, and is of gain and none what they leave. Precondition: rate > 2 band.high_hz.
InverseFilter inverse_filter(const Chain& chain, Inverse inverse, const spatial::Band& band,
                             const InverseDesign& design);

}  // namespace tacto::playback

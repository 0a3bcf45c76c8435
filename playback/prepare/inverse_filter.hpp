// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse of the chain as a finite filter that runs tick by tick.
#pragma once

#include <vector>

#include "firmware-host/core/wire/message_types.hpp"
#include "playback/model/chain.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

struct InverseDesign {
  double delay_s = 2e-3;      ///< of filter and chain together
  double most_gain_db = 20;   ///< re its gain at rest
  double stops_at_hz = 1250;  ///< there is no input beyond it
  std::size_t taps = 0;       ///< 0: the default
};

/// A filter of V for m at the chain's rate, and its errors.
struct InverseFilter {
  std::vector<float> taps;
  std::size_t solutions = 0;  ///< least-squares problems solved; 0 for a gain alone
  double delay_s = 0;         ///< of filter and chain together
  double error_db = 0;        ///< RMS over the band of |chain filter - exp(-2 pi i f delay)|, re 1
  double gain_db = 0;         ///< largest, re the gain at rest, including the chain's lead
  double beyond_band_db = 0;  ///< largest |chain filter| from the band's edge to stops_at_hz or half the rate
};

/// A tenth of the target: an inverse with a larger residual is refused.
inline constexpr double kMostInverseErrorDb = -20;

/// full: min sum_f |C g - exp(-2 pi i f d)|^2 over 0 to band.high_hz (a tenth of the weight below
/// band.low_hz), + 1e-6 |C g|^2 beyond, + p(f) |g|^2 there, where p is increased by iteration (Lawson)
/// wherever |g| exceeds most_gain_db (g times the lead behind it, if the chain has one). C is the chain over
/// its gain at rest. Default: 3.2 ms of taps, at least 24, at most 128. For the paper's transducer, 2 kHz to
/// 20 kHz, 2 ms: error below -69 dB; with its 600 Hz filter below -55 dB. magnitude: the same with |C| for C,
/// so the chain's phase remains; gain, none: one tap, no delay. `error_db` is that of the amplitude alone for
/// magnitude, and includes all residuals for gain and none. Precondition: rate > 2 band.high_hz.
InverseFilter inverse_filter(const Chain& chain, Inverse inverse, const spatial::Band& band,
                             const InverseDesign& design);

}  // namespace tacto::playback

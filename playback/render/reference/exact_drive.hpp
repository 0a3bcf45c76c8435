// SPDX-License-Identifier: GPL-3.0-or-later
// From a wanted displacement to the drive and back, exactly, in the frequency domain.
#pragma once

#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "playback/model/chain.hpp"
#include "playback/model/limits.hpp"
#include "playback/render/reference/padded_spectrum.hpp"

namespace tacto::playback {

/// A drive as it is stored, and what it moves: the transducer's model, with the hysteresis of its file.
struct ExactDrive {
  std::vector<double> drive_v;     ///< rounded to 32-bit float
  std::vector<double> modelled_m;  ///< at the same rate
  Peaks peaks;
};

/// W(f) x inverse inside the band, zero outside, back in time and cut to the wanted signal's length. Peaks
/// also count what lies between samples, from at least 16 points a period of band.high_hz (within 2 %).
ExactDrive exact_drive(const PaddedSpectrum& target, const spatial::Band& band, const Chain& chain,
                       Inverse inverse);

/// A drive that somebody else computed: rounded, and what it moves.
ExactDrive moved_by(std::vector<double> drive_v, const PaddedSpectrum& target, const Chain& chain);

/// The same held within the transducer's limits at the samples: the wanted displacement is clipped and its
/// band kept again, the drive clipped in level and in slew, repeated with a lower ceiling while the modelled
/// displacement still passes its limit. Errors: unsuitable, where 20 rounds don't bring it under.
schema::Result<ExactDrive> clipped_drive(const PaddedSpectrum& target, const spatial::Band& band,
                                         const Chain& chain, Inverse inverse);

}  // namespace tacto::playback

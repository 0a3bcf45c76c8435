// SPDX-License-Identifier: GPL-3.0-or-later
// From a target displacement to the drive and back, exactly, in the frequency domain.
#pragma once

#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "playback/model/chain.hpp"
#include "playback/model/limits.hpp"
#include "playback/render/reference/padded_spectrum.hpp"

namespace tacto::playback {

/// A drive as it is stored, and the displacement of the transducer's model, with the hysteresis of its file.
struct ExactDrive {
  std::vector<double> drive_v;     ///< rounded to 32-bit float
  std::vector<double> modelled_m;  ///< at the same rate
  Peaks peaks;
};

/// W(f) x inverse inside the band, zero outside, transformed back and cut to the target's length. Peaks
/// include values between samples, at 16 points or more per period of band.high_hz (error within 2 %).
ExactDrive exact_drive(const PaddedSpectrum& target, const spatial::Band& band, const Chain& chain,
                       Inverse inverse);

/// Rounds a drive of another engine, and computes its displacement.
ExactDrive modelled_from(std::vector<double> drive_v, const PaddedSpectrum& target, const Chain& chain);

/// The drive clipped to the transducer's limits at the samples: the target displacement is clipped and
/// filtered to the band again, the drive is clipped in level and in slew; repeated with a lower ceiling while
/// the modelled displacement exceeds its limit. Errors: unsuitable, if 20 rounds are not enough.
schema::Result<ExactDrive> clipped_drive(const PaddedSpectrum& target, const spatial::Band& band,
                                         const Chain& chain, Inverse inverse);

}  // namespace tacto::playback

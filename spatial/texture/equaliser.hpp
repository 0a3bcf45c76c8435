// SPDX-License-Identifier: GPL-3.0-or-later
// From what the sensor gave to what pulled on it: division by the sensor's frequency response.
#pragma once

#include "data-schema/transducer/transducer.hpp"
#include "spatial/dsp/filter/fourier_filter.hpp"

namespace tacto::spatial {

/// The largest gain that equalising gives, 20 dB: below 1 Hz and far above the resonance the sensor tells
/// nothing, and its noise must not become force.
inline constexpr double kMostEqualiserGain = 10;

/// 1 / (H_s(f) x nominal newtons per volt): a recording in nominal newtons, times this, is in true newtons.
/// With the exact phase everywhere, and the exact size where it is under kMostEqualiserGain; 0 at 0 Hz, which
/// a charge sensor cannot see. (PAPERS.md: the sensor's gain is level only from about 20 to 150 Hz;
/// Wiertlewski 2011, H_s.)
SpectralGain equaliser(const schema::Transducer& transducer);

}  // namespace tacto::spatial

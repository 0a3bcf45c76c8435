// SPDX-License-Identifier: GPL-3.0-or-later
// Butterworth band-pass as second-order sections: bilinear transform, both edges prewarped.
#pragma once

#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/filter/sections.hpp"

namespace tacto::spatial {

/// The digital filter of scipy.signal.butter(order, [low, high], "bandpass", output="sos"): `order` sections,
/// -3 dB at both edges (-6 dB after running forwards and backwards). Errors: usage for an order outside 1 ...
/// 20; unsuitable unless 0 < low < high < sample rate / 2.
schema::Result<std::vector<Section>> butterworth_band_pass(int order, Band band, double sample_rate_hz);

/// The part of the band in which the filter, run forwards and backwards, keeps at least `amplitude` (0 to 1):
/// from |H|^2 = 1 / (1 + w^(2 order)), exact for the digital filter. Precondition: as butterworth_band_pass.
Band zero_phase_band(int order, Band band, double sample_rate_hz, double amplitude);

}  // namespace tacto::spatial

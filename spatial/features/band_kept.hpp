// SPDX-License-Identifier: GPL-3.0-or-later
// The share of a texture's power that is in the band of a playback.
#pragma once

#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::spatial {

/// Power of the texture within the band (Hz) at a speed, in percent of its power from one period per length
/// up. Computed from the steady part (spatial::steady_part) with one Hann window over all samples, also those
/// outside of the valid band. The power of a bin counts at the frequency from which it comes, the centre of
/// the energy under the window (Auger and Flandrin 1995, IEEE Trans. Signal Processing 43(5)), and not at the
/// frequency of the bin. So a line near the band's edge is inside or outside as a whole. 100 for a texture
/// without power or with fewer than 8 samples. Not safe in the tick.
double band_kept_percent(const schema::Texture& texture, double speed_mps, const Band& band);

}  // namespace tacto::spatial

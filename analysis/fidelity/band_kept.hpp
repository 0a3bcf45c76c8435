// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a texture lies in the band of a playback.
#pragma once

#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

/// Power of the texture within the band (Hz) at a speed, in percent of all its power from one period a length
/// up. It is of the steady part (spatial::steady_part) under one Hann window, of all samples, whether or not
/// the texture knows them throughout. Each bin's power counts at the frequency from which it comes, not at
/// the bin's: the centre of the energy under the window (Auger and Flandrin 1995, IEEE Trans. Signal
/// Processing 43(5)). So a line beside the band's edge counts as within or beyond it as a whole. 100 for a
/// texture without power, or of fewer than 8 samples. Not for the tick.
double band_kept_percent(const schema::Texture& texture, double speed_mps, const spatial::Band& band);

}  // namespace tacto::analysis

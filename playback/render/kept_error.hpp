// SPDX-License-Identifier: GPL-3.0-or-later
// The relative error of a rendering without its ends: `render` reports it, and a budget is compared with
// it.
#pragma once

#include "playback/render/reference/padded_spectrum.hpp"
#include "playback/render/render.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// Duration left out at each end: 1 s, or the onset if that is longer; at most a quarter of the rendering. If
/// the finger moves at an end of its path, there is a step, which no drive in the band can follow.
double left_out_at_ends_s(const Rendering& rendering);

/// RMS over the band of modelled - target, re that of the target, 1; without left_out_at_ends_s() at each
/// end. NaN if the target is zero in between.
double error_between_ends(const Rendering& rendering, const PaddedSpectrum& target,
                          const spatial::Band& band);

}  // namespace tacto::playback

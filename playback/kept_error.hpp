// SPDX-License-Identifier: GPL-3.0-or-later
// What a budget is held against: the error of a rendering where no end is near.
#pragma once

#include "playback/reference/padded_spectrum.hpp"
#include "playback/render.hpp"
#include "spatial/dsp/band.hpp"

namespace tacto::playback {

/// RMS over the band of modelled - wanted, re that of wanted, 1. 1 s at either end is left out, of short
/// renderings a quarter: where a path doesn't rest at its end, it ends with a step, which no drive in the
/// band can follow. Not a number where nothing is wanted in between.
double error_between_ends(const Rendering& rendering, const PaddedSpectrum& wanted,
                          const spatial::Band& band);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a rendering away from its ends: what a budget is held against, and what `render` reports
// first.
#pragma once

#include "playback/render/reference/padded_spectrum.hpp"
#include "playback/render/render.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// What is left out at either end: 1 s, or the onset where that is longer; of short renderings a quarter.
/// Where a path does not rest at its end, it ends with a step, which no drive in the band can follow.
double left_out_at_ends_s(const Rendering& rendering);

/// RMS over the band of modelled - wanted, re that of wanted, 1; without left_out_at_ends_s() at either end.
/// Not a number where nothing is wanted in between.
double error_between_ends(const Rendering& rendering, const PaddedSpectrum& target,
                          const spatial::Band& band);

}  // namespace tacto::playback

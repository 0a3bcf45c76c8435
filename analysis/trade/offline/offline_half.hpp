// SPDX-License-Identifier: GPL-3.0-or-later
// Error and cost of each choice between a recording and a spectrogram, on a given texture.
#pragma once

#include <functional>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// The texture is filtered to the band of 20-450 Hz for a finger of 50 mm/s whose speed varies by a tenth,
/// sampled along that motion at 10 kHz with exact positions, and resampled to space by each choice.
/// References: for "interpolation and grid" and "stored" the texture itself, by windowed sinc on its own grid
/// (1e-6); for "filter" the same force without the components that were added outside of its band (a drift at
/// 2 Hz, a hum at 1.7 kHz, each half of its RMS), without the first and last 5 % of the record; for
/// "resolution" extended precision; for "hop" every row; for "padding" 16 times the padding; for "window" the
/// energy by octaves in the texture's middle. Errors: unsuitable: a texture shorter than 12 mm or with a
/// pitch over 50 um.
schema::Result<std::vector<TradeRow>> measure_offline(const schema::Texture& texture,
                                                      const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis

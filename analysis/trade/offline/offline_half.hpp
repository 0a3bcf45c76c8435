// SPDX-License-Identifier: GPL-3.0-or-later
// What each choice on the way from a recording to a spectrogram costs and errs, on a given texture.
#pragma once

#include <functional>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// The texture, cut to the band that 20-450 Hz are to a finger of 50 mm/s whose speed wanders by a tenth, is
/// stroked at 10 kHz with exact positions, and taken back to space by each choice. References: the texture
/// itself, by windowed sinc on its own grid (1e-6) for "interpolation and grid" and "stored"; the same force
/// without what was added outside of its band (a drift at 2 Hz, a hum at 1.7 kHz, each a half of its RMS) for
/// "filter", the record's first and last 5 % left out; extended precision for "resolution"; every row for
/// "hop", 16 times the padding for "padding"; the energy of the texture's middle by octaves for "window".
/// Errors: unsuitable, for a texture shorter than 12 mm or of a pitch over 50 um.
schema::Result<std::vector<TradeRow>> measure_offline(const schema::Texture& texture,
                                                      const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis

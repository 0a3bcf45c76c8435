// SPDX-License-Identifier: GPL-3.0-or-later
// Cost and error of each choice of a spectrogram.
#pragma once

#include <vector>

#include "analysis/trade/offline/spectrogram_errors.hpp"
#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

// Pairs of spectrogram choices that change each other's error.

/// "window x hop": a wider window smooths the power along the texture, so that a larger hop is sufficient.
/// "window x padding": a line between two bins loses the same fraction of its height with any window, but
/// padding a narrow window costs less. Error: the root of the sum of squares of the window's effect on the
/// energy by octaves, and of the hop's effect on the power between rows or the padding's on the height of the
/// peaks (re 16 times the padding); the note has both. Errors: those of spatial_spectrogram.
schema::Result<std::vector<TradeRow>> measure_spectrogram_pairs(const schema::Texture& texture,
                                                                const OctaveEnergy& energy);

/// Varies resolution, hop, padding and window, one at a time, from the standard ones; references: see
/// measure_offline. Cost in ns per sample of the texture. Errors: those of spatial_spectrogram.
schema::Result<std::vector<TradeRow>> measure_spectrogram_trade(const schema::Texture& texture);

}  // namespace tacto::analysis

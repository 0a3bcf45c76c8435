// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of spectrogram choices that change each other's error.
#pragma once

#include <vector>

#include "analysis/trade/offline/spectrogram_errors.hpp"

namespace tacto::analysis {

/// "window x hop": a wider window smooths the power along the texture, so that a larger hop is sufficient.
/// "window x padding": a line between two bins loses the same fraction of its height with any window, but
/// padding a narrow window costs less. Error: the root of the sum of squares of the window's effect on the
/// energy by octaves, and of the hop's effect on the power between rows or the padding's on the height of the
/// peaks (re 16 times the padding); the note has both. Errors: those of spatial_spectrogram.
schema::Result<std::vector<TradeRow>> measure_spectrogram_pairs(const schema::Texture& texture,
                                                                const OctaveEnergy& energy);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// The choices of a spectrogram that change what one another err.
#pragma once

#include <vector>

#include "analysis/trade/offline/spectrogram_errors.hpp"

namespace tacto::analysis {

/// "window x hop": a wider window smooths the power along the texture, so that rows may lie farther apart;
/// "window x padding": a line between two bins loses the same of its height whatever the window, but a
/// narrow window's side costs less. Error: the root of the sum of squares of what the window does to the
/// energy by octaves, and of what the hop does to the power between rows, or the padding to the height of the
/// peaks (re 16 times the padding); the note tells both. Errors: of spatial_spectrogram.
schema::Result<std::vector<TradeRow>> measure_spectrogram_pairs(const schema::Texture& texture,
                                                                const OctaveEnergy& energy);

}  // namespace tacto::analysis

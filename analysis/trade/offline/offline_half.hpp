// SPDX-License-Identifier: GPL-3.0-or-later
// Error and cost of each choice between a recording and a spectrogram, on a given texture.
#pragma once

#include <functional>
#include <vector>

#include "analysis/trade/offline/spectrogram_errors.hpp"
#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/results/trade_table.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/texture/resample.hpp"

namespace tacto::analysis {

/// Pairs of spectrogram choices that change each other's error. "window x hop": a wider window smooths the
/// power along the texture, so that a larger hop is sufficient. "window x padding": a line between two bins
/// loses the same fraction of its height with any window, but padding a narrow window costs less. Error: the
/// root of the sum of squares of the window's effect on the energy by octaves, and of the hop's effect on the
/// power between rows or the padding's on the height of the peaks (re 16 times the padding); the note has
/// both. Errors: those of spatial_spectrogram.
schema::Result<std::vector<TradeRow>> measure_spectrogram_pairs(const schema::Texture& texture,
                                                                const OctaveEnergy& energy);

// For the table of measured choices.

/// Each method of resampling from time to space: the error of a sine of so many frames per period at its
/// highest local frequency, the worst of fingers of constant and of varying speed; cost per sample of a grid
/// with 5 samples per frame.
std::vector<schema::MeasuredChoice> measure_resampling();

/// Interpolation of a texture by cubic Hermite: the error of a sine of so many samples per period.
schema::MeasuredChoice measure_grid();

/// Spectrogram cells: largest |X - exact| re the largest exact |X|, against extended precision.
std::vector<schema::MeasuredChoice> measure_spectrogram();

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

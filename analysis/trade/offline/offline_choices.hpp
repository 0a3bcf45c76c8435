// SPDX-License-Identifier: GPL-3.0-or-later
// The offline half of the table of measured choices: resampling, grid, spectrogram.
#pragma once

#include <vector>

#include "data-schema/results/trade_table.hpp"
#include "spatial/texture/resample.hpp"

namespace tacto::analysis {

/// Each method of resampling from time to space: the error of a sine of so many frames per period at its
/// highest local frequency, the worst of fingers of constant and of varying speed; cost per sample of a grid
/// with 5 samples per frame.
std::vector<schema::MeasuredChoice> measure_resampling();

/// Interpolation of a texture by cubic Hermite: the error of a sine of so many samples per period.
schema::MeasuredChoice measure_grid();

/// Spectrogram cells: largest |X - exact| re the largest exact |X|, against extended precision.
std::vector<schema::MeasuredChoice> measure_spectrogram();

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// The offline half of the table of measured choices: resampling, grid, spectrogram.
#pragma once

#include <vector>

#include "data-schema/results/trade_table.hpp"
#include "spatial/texture/resample.hpp"

namespace tacto::analysis {

/// Each way from time to space: the error of a sine of so many frames a period at its highest local
/// frequency, the worst of fingers of even and of wandering speed; cost a sample of a grid with 5 a frame.
std::vector<schema::MeasuredChoice> measure_resampling();

/// Reading a texture between its samples by cubic Hermite: the error of a sine of so many samples a period.
schema::MeasuredChoice measure_grid();

/// Computing a spectrogram's cells: largest |X - exact| re the largest exact |X|, against extended precision.
std::vector<schema::MeasuredChoice> measure_spectrogram();

}  // namespace tacto::analysis

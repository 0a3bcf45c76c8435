// SPDX-License-Identifier: GPL-3.0-or-later
// Band-pass in the Fourier transform of a whole record (Wiertlewski 2011), with a gain in the band.
#pragma once

#include <span>
#include <vector>

#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/dsp/filter/record_ends.hpp"

namespace tacto::spatial {

/// Keeps the content of the band, multiplied by `gain` if there is one; the result has the same number of
/// values and unit. Edges::none is the plain truncation of the record, equal to SciPy's rfft, mask and irfft:
/// the record is treated as periodic, unequal ends cause ringing, and content at the band's edges passes or
/// not depending on the record's bins. It also needs memory for the record's spectrum. Edges::treated is
/// BlockFourierFilter over the whole record, in 10 MB. Its error for content well inside the band (20 to 400
/// Hz of 15 to 500) under drift and offset, in 2 s, re its RMS: 0.2 % in the middle half, 0.7 % from 0.3 to
/// 0.1 s before an end, 6 % in the last 0.1 s; that of plain truncation is 40 times as large if the ends are
/// 20 RMS apart (fourier_filter_test). On the bare-finger recording it differs by 0.08 % of the RMS from the
/// ideal kernel, plain truncation by 2.6 %.
std::vector<double> fourier_filter(std::span<const double> values, double sample_rate_hz, Band band,
                                   Edges edges, const SpectralGain& gain = {});

}  // namespace tacto::spatial

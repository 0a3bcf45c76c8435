// SPDX-License-Identifier: GPL-3.0-or-later
// Band-pass in the Fourier transform of a whole record (Wiertlewski 2011), with a gain in the band.
#pragma once

#include <span>
#include <vector>

#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/dsp/filter/record_ends.hpp"

namespace tacto::spatial {

/// Keeps what lies in the band, times `gain` where there is one, and gives as many values in the same unit.
/// Edges::none is the plain truncation of the record, equal to SciPy's rfft, mask and irfft: it takes the
/// record for periodic, rings from unequal ends, and what lies just at the band's edges passes or not by
/// where the record's bins happen to lie. It takes memory for the record's spectrum as well.
/// Edges::treated is BlockFourierFilter over the whole record, in 10 MB. Error for what lies well in the band
/// (20 to 400 Hz of 15 to 500) under drift and offset, in 2 s, re its RMS: 0.2 % in the middle half, 0.7 %
/// from 0.3 to 0.1 s before an end, 6 % in the last 0.1 s; of the plain one 40 times that where the ends lie
/// 20 RMS apart (fourier_filter_test). On the bare-finger recording it is 0.08 % of the RMS from the ideal
/// kernel, plain truncation 2.6 %.
std::vector<double> fourier_filter(std::span<const double> values, double sample_rate_hz, Band band,
                                   Edges edges, const SpectralGain& gain = {});

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// Truncation of the Fourier transform by its definition, in extended precision.
#pragma once

#include <span>
#include <vector>

#include "spatial/dsp/filter/band.hpp"

namespace tacto::spatial::reference {

/// The result of fourier_filter with Edges::none and no gain: each frequency of the record that is in the
/// band, summed directly. Cost: size x (frequencies in the band) steps, so for records of some thousand
/// samples.
std::vector<double> exact_band_pass(std::span<const double> values, double sample_rate_hz, Band band);

}  // namespace tacto::spatial::reference

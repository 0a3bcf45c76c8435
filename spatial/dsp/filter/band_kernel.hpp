// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of the Fourier band-pass with treated ends: the ideal kernel under a window, so that its length
// is finite.
#pragma once

#include <cstddef>
#include <vector>

#include "spatial/dsp/filter/band.hpp"

namespace tacto::spatial {

/// Share of the kernel's half length over which the window is 1.
inline constexpr double kFlatShare = 0.3;

/// The window at a distance of `share` of the half length: 1 up to kFlatShare, then down to 0 at 1 with three
/// continuous derivatives.
double kernel_window(double share);

/// Taps 0 ... reach of the symmetric kernel k(n) = w(n / reach) (2 h sinc(2 h n) - 2 l sinc(2 l n)), with the
/// edges h and l over the sample rate. 0 Hz passes completely if the band begins there, otherwise not at all;
/// an edge at half the rate passes everything below it. The window determines the width of the transitions:
/// at a distance from an edge of more than 2.5 sample_rate_hz / reach the gain is exact to 1e-3, of more than
/// 8 sample_rate_hz / reach to 1e-6. At least 2 taps.
std::vector<double> band_kernel(Band band, double sample_rate_hz, std::size_t reach);

}  // namespace tacto::spatial

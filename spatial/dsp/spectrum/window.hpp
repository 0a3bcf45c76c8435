// SPDX-License-Identifier: GPL-3.0-or-later
// Windows of short-time transforms.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::spatial {

/// Blackman's window, periodic as SciPy's default for spectra:
/// w_n = 0.42 - 0.5 cos(2 pi n / length) + 0.08 cos(4 pi n / length), n < length.
std::vector<double> blackman(std::size_t length);

/// Mean of the window: a sine of amplitude A gives A / 2 times this and the window's length.
inline constexpr double kBlackmanMean = 0.42;

/// Hann's window, periodic: w_n = 0.5 - 0.5 cos(2 pi n / length), n < length.
std::vector<double> hann(std::size_t length);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// The short-time Fourier transform by its definition in extended precision. It is slow. Its error is 1e-18 of
// a row's largest value times the logarithm of its length.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "spatial/dsp/resample/decimation.hpp"

namespace tacto::spatial::reference {

/// X_k = sum_n x_n exp(-2 pi i k n / length), for any length: Cooley and Tukey (1965) while the length is
/// even, then the plain sum.
std::vector<std::complex<long double>> exact_fourier(std::span<const long double> x);

/// Row p: X_k = sum_n w_n (x[p hop + n] - mean_p) exp(-2 pi i k n / padded) for k from 0 to padded / 2, with
/// Blackman's w_n = 0.42 - 0.5 cos(2 pi n / window) + 0.08 cos(4 pi n / window), and mean_p = 0 without
/// `detrend`. Precondition: the row is inside the signal.
std::vector<std::complex<long double>> exact_short_time_row(std::span<const double> signal,
                                                            const FrameShape& shape, std::size_t row,
                                                            bool detrend);

}  // namespace tacto::spatial::reference

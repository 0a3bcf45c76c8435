// SPDX-License-Identifier: GPL-3.0-or-later
// One line of a spectrum, without a transform of the whole.
#pragma once

#include <complex>
#include <span>

namespace tacto::capture {

/// X(f) = sum over n of w_n (x_n - mean of x) e^(-2 pi i f n), with Hann's w_n = (1 - cos(2 pi n / N)) / 2;
/// `cycles` is f in cycles per sample. The sum of w is N/2, of its squares 3N/8, so a sinusoid of amplitude a
/// has |X| = a N/4, and white noise of one-sided density S at the rate r a mean |X|^2 of S r 3N/16. The
/// factors turn by multiplication: off by 1e-16 N at most.
std::complex<double> hann_line(std::span<const double> samples, double cycles);

/// A sinusoid's amplitude.
double amplitude_of(std::complex<double> line, std::size_t samples);

/// One-sided power spectral density, in the samples' unit squared per hertz.
double density_of(std::complex<double> line, std::size_t samples, double sample_rate_hz);

}  // namespace tacto::capture

// SPDX-License-Identifier: GPL-3.0-or-later
// The Fourier transform of samples at one frequency, under a Hann window.
#pragma once

#include <complex>
#include <span>

namespace tacto::capture {

/// X(f) = sum over n of w_n (x_n - mean of x) e^(-2 pi i f n), with the Hann window w_n = (1 - cos(2 pi n /
/// N)) / 2; `cycles` is f in cycles per sample. The sum of w is N/2, the sum of its squares 3N/8. So a
/// sinusoid of amplitude a has |X| = a N/4, and white noise of one-sided density S at the sample rate r has a
/// mean |X|^2 of S r 3N/16. The complex factors are computed by repeated multiplication; the error is at most
/// 1e-16 N.
std::complex<double> hann_line(std::span<const double> samples, double cycles);

/// The amplitude of a sinusoid.
double amplitude_of(std::complex<double> line, std::size_t samples);

/// One-sided power spectral density, in the samples' unit squared per hertz.
double density_of(std::complex<double> line, std::size_t samples, double sample_rate_hz);

}  // namespace tacto::capture

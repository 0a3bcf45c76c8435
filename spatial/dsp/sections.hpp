// SPDX-License-Identifier: GPL-3.0-or-later
// Recursive filters as a chain of second-order sections, run forwards and backwards so that nothing is
// delayed.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tacto::spatial {

/// H(z) = (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2).
struct Section {
  double b0, b1, b2, a1, a2;
  std::complex<double> response(double frequency_hz, double sample_rate_hz) const;
};

/// The chain's complex gain.
std::complex<double> response_of(std::span<const Section> sections, double frequency_hz,
                                 double sample_rate_hz);

/// Samples of odd extension that scipy.signal.sosfiltfilt takes unless told.
std::size_t default_padding(std::span<const Section> sections);

/// Forwards, then backwards: gain |H|^2, no delay. The record is point-mirrored over `padding` samples at
/// each end (fewer where it is shorter), and the sections start in the steady state of the first value, as
/// sosfiltfilt does.
std::vector<double> filter_zero_phase(std::span<const Section> sections, std::span<const double> values,
                                      std::size_t padding);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// The complex amplitude of a known frequency in evenly spaced samples.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <span>

namespace tacto::tests {

/// The A of Re(A e^(2 pi i f t)), for samples with whole periods: sample i is at (first + i) / rate.
inline std::complex<double> sine_fit(std::span<const double> samples, std::size_t first, double rate_hz,
                                     double frequency_hz) {
  std::complex<double> sum;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double turns = frequency_hz * static_cast<double>(first + i) / rate_hz;
    sum += samples[i] * std::polar(1.0, -2 * std::numbers::pi * turns);
  }
  return sum * 2.0 / static_cast<double>(samples.size());
}

}  // namespace tacto::tests

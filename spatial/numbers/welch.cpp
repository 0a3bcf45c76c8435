// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/numbers/welch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/dsp/spectrum/window.hpp"

namespace tacto::spatial {

WelchSpectrum::WelchSpectrum(std::span<const double> values, double pitch, std::size_t window)
    : step_(1 / (static_cast<double>(window) * pitch)) {
  RealFft fft(window);
  const auto weights = hann(window);
  std::vector<double> frame(window);
  std::vector<std::complex<double>> spectrum(fft.bins());
  density_.assign(fft.bins(), 0);
  const std::size_t hop = window - window / 2;
  for (std::size_t from = 0; from + window <= values.size(); from += hop, ++windows_) {
    const auto part = values.subspan(from, window);
    const double mean = std::accumulate(part.begin(), part.end(), 0.0) / static_cast<double>(window);
    for (std::size_t n = 0; n < window; ++n) frame[n] = weights[n] * (part[n] - mean);
    fft.forward(frame, spectrum);
    for (std::size_t k = 0; k < spectrum.size(); ++k) density_[k] += std::norm(spectrum[k]);
  }
  const double power = std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
  const double scale = pitch / (power * static_cast<double>(windows_));
  for (std::size_t k = 0; k < density_.size(); ++k)
    density_[k] *= scale * (k == 0 || 2 * k == window ? 1 : 2);  // no counterpart at negative frequencies
}

double WelchSpectrum::integral(double from, double to, bool weighted) const {
  double sum = 0;
  const auto first = static_cast<std::size_t>(std::lround(from / step_));
  for (std::size_t k = first; k < density_.size(); ++k) {
    const double low = std::max(from, (static_cast<double>(k) - 0.5) * step_);
    const double high = std::min(to, (static_cast<double>(k) + 0.5) * step_);
    if (low >= to) break;
    if (high > low) sum += density_[k] * (weighted ? 0.5 * (high * high - low * low) : high - low);
  }
  return sum;
}

}  // namespace tacto::spatial

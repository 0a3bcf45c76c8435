// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/dft321.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numeric>

#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::spatial {
namespace {

double product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double correlation(std::span<const std::span<const double>> axes, std::span<const double> values) {
  double common = 0, all = 0;
  for (const auto& axis : axes) {
    const double with = product(axis, values);
    common += with * with;
    all += product(axis, axis);
  }
  all *= product(values, values);
  return all > 0 ? std::min(std::sqrt(common / all), 1.0) : 1;
}

}  // namespace

Dft321 dft321(std::span<const std::span<const double>> axes) {
  RealFft fft(axes.front().size());
  std::vector<std::complex<double>> spectrum(fft.bins()), sum(fft.bins());
  std::vector<double> power(fft.bins());
  for (const auto& axis : axes) {
    fft.forward(axis, spectrum);
    for (std::size_t k = 0; k < sum.size(); ++k) {
      sum[k] += spectrum[k];
      power[k] += std::norm(spectrum[k]);
    }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = std::polar(std::sqrt(power[k]), std::arg(sum[k]));
  Dft321 one{std::vector<double>(fft.length())};
  fft.inverse(sum, one.values);
  one.waveform_correlation = correlation(axes, one.values);
  return one;
}

}  // namespace tacto::spatial

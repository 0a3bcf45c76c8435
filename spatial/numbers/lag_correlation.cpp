// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/numbers/lag_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::spatial {
namespace {

using Lag = std::ptrdiff_t;
using PaddedSpectrum = std::vector<std::complex<double>>;

PaddedSpectrum padded_spectrum(RealFft& fft, std::span<const double> values) {
  std::vector<double> padded(fft.length(), 0.0);
  std::ranges::copy(values, padded.begin());
  PaddedSpectrum spectrum(fft.bins());
  fft.forward(padded, spectrum);
  return spectrum;
}

std::vector<double> lag_products(std::span<const double> a, std::span<const double> b) {
  RealFft fft(fast_length(a.size() + b.size()));
  const PaddedSpectrum of_a = padded_spectrum(fft, a);
  PaddedSpectrum of_b = padded_spectrum(fft, b);
  for (std::size_t k = 0; k < of_b.size(); ++k) of_b[k] *= std::conj(of_a[k]);
  std::vector<double> sums(fft.length());
  fft.inverse(of_b, sums);
  return sums;
}

std::vector<double> running_energy(std::span<const double> values) {
  std::vector<double> energy(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) energy[i + 1] = energy[i] + values[i] * values[i];
  return energy;
}

double energy_within(const std::vector<double>& energy, Lag begin, Lag end) {
  return energy[static_cast<std::size_t>(end)] - energy[static_cast<std::size_t>(begin)];
}

}  // namespace

LagCorrelation::LagCorrelation(std::span<const double> a, std::span<const double> b)
    : a_size_(static_cast<Lag>(a.size())),
      b_size_(static_cast<Lag>(b.size())),
      products_(lag_products(a, b)),
      a_energy_(running_energy(a)),
      b_energy_(running_energy(b)) {}

double LagCorrelation::at(Lag lag) const {
  const Lag begin = std::max<Lag>(0, -lag), end = std::min(a_size_, b_size_ - lag);
  if (2 * (end - begin) < std::min(a_size_, b_size_)) return -1;
  const double energy =
      energy_within(a_energy_, begin, end) * energy_within(b_energy_, begin + lag, end + lag);
  const auto length = static_cast<Lag>(products_.size());
  return energy > 0 ? products_[static_cast<std::size_t>((lag + length) % length)] / std::sqrt(energy) : 0;
}

}  // namespace tacto::spatial

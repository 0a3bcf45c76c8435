// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/align_textures.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::spatial {
namespace {

// Below this, two textures share less than a tenth of their power, so that agreement may be chance.
constexpr double kLeastCorrelation = 0.3;

using Index = std::ptrdiff_t;
using Spectrum = std::vector<std::complex<double>>;

Spectrum spectrum_of(RealFft& fft, std::span<const double> values) {
  std::vector<double> padded(fft.length(), 0.0);
  std::ranges::copy(values, padded.begin());
  Spectrum spectrum(fft.bins());
  fft.forward(padded, spectrum);
  return spectrum;
}

// sum_i a[i] b[i + m] at index m; negative m are at the end.
std::vector<double> products(std::span<const double> a, std::span<const double> b) {
  RealFft fft(fast_length(a.size() + b.size()));
  const Spectrum of_a = spectrum_of(fft, a);
  Spectrum of_b = spectrum_of(fft, b);
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

// Correlation of a[i] and b[i + m] over their overlap.
class Correlation {
 public:
  Correlation(std::span<const double> a, std::span<const double> b)
      : a_size_(static_cast<Index>(a.size())),
        b_size_(static_cast<Index>(b.size())),
        products_(products(a, b)),
        a_energy_(running_energy(a)),
        b_energy_(running_energy(b)) {}

  double at(Index m) const {
    const Index begin = std::max<Index>(0, -m), end = std::min(a_size_, b_size_ - m);
    if (2 * (end - begin) < std::min(a_size_, b_size_)) return -1;
    const double energy = within(a_energy_, begin, end) * within(b_energy_, begin + m, end + m);
    const auto length = static_cast<Index>(products_.size());
    return energy > 0 ? products_[static_cast<std::size_t>((m + length) % length)] / std::sqrt(energy) : 0;
  }

 private:
  static double within(const std::vector<double>& energy, Index begin, Index end) {
    return energy[static_cast<std::size_t>(end)] - energy[static_cast<std::size_t>(begin)];
  }
  Index a_size_, b_size_;
  std::vector<double> products_, a_energy_, b_energy_;
};

}  // namespace

Alignment align(const BenchValues& a, const BenchValues& b, double range) {
  const Correlation correlation(a.values, b.values);
  const auto apart = static_cast<Index>(std::lround(a.first - b.first));
  const auto reach = static_cast<Index>(std::floor(range));
  Index best = -reach;
  for (Index lag = -reach; lag <= reach; ++lag)
    if (correlation.at(apart + lag) > correlation.at(apart + best)) best = lag;
  const double top = correlation.at(apart + best);
  if (top < kLeastCorrelation || best == -reach || best == reach) return {0, correlation.at(apart), false};
  const double before = correlation.at(apart + best - 1), after = correlation.at(apart + best + 1);
  const double bend = before - 2 * top + after, off = bend < 0 ? (before - after) / (2 * bend) : 0;
  return {-(static_cast<double>(best) + off), top - (before - after) * off / 4, true};
}

}  // namespace tacto::spatial

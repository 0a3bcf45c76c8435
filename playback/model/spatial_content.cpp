// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/spatial_content.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "data-schema/base/raised_cosine.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::playback {
namespace {

constexpr double kNegligibleShare = 1e-10;

std::vector<double> energies(const schema::SpaceSignal& texture, std::size_t length) {
  const auto n = static_cast<double>(texture.values.size());
  const double mean = std::accumulate(texture.values.begin(), texture.values.end(), 0.0) / n;
  std::vector<double> windowed(length, 0.0);
  for (std::size_t i = 0; i < texture.values.size(); ++i)
    windowed[i] = (texture.values[i] - mean) *
                  schema::rising_cosine(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / n);
  spatial::RealFft fft(length);
  std::vector<std::complex<double>> bins(fft.bins());
  fft.forward(windowed, bins);
  std::vector<double> energy(bins.size());
  for (std::size_t k = 0; k < bins.size(); ++k) energy[k] = std::norm(bins[k]);
  return energy;
}

}  // namespace

double highest_spatial_frequency(const schema::SpaceSignal& texture) {
  const std::size_t length = spatial::fast_length(texture.values.size());
  const auto energy = energies(texture, length);
  const double negligible = kNegligibleShare * std::accumulate(energy.begin(), energy.end(), 0.0);
  double above = 0;
  std::size_t k = energy.size();
  while (k > 0 && above + energy[k - 1] <= negligible) above += energy[--k];
  return static_cast<double>(k) / (static_cast<double>(length) * texture.pitch_m);
}

double relative_slope(const schema::SpaceSignal& texture, double low_per_m, double high_per_m) {
  const std::size_t length = spatial::fast_length(texture.values.size());
  const auto energy = energies(texture, length);
  double whole = 0, steep = 0;
  for (std::size_t k = 0; k < energy.size(); ++k) {
    const double per_m = static_cast<double>(k) / (static_cast<double>(length) * texture.pitch_m);
    if (per_m < low_per_m || per_m > high_per_m) continue;
    whole += energy[k];
    steep += energy[k] * per_m * per_m;
  }
  return whole > 0 ? 2 * std::numbers::pi * std::sqrt(steep / whole) : 0;
}

}  // namespace tacto::playback

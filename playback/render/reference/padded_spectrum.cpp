// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/padded_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data-schema/base/raised_cosine.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::playback {
namespace {
constexpr double kLowSkirt = 0.2;
constexpr double kHighSkirt = 0.01;
}  // namespace

PaddedSpectrum spectrum_of(std::span<const double> values, double rate_hz, std::size_t period) {
  PaddedSpectrum spectrum{rate_hz, values.size(), period, {}};
  spatial::RealFft fft(period);
  std::vector<double> padded(period, 0.0);
  std::ranges::copy(values, padded.begin());
  spectrum.bins.resize(fft.bins());
  fft.forward(padded, spectrum.bins);
  return spectrum;
}

std::vector<double> signal_of(const PaddedSpectrum& spectrum, std::size_t oversampling) {
  spatial::RealFft fft(spectrum.period * oversampling);
  auto bins = spectrum.bins;
  // The bin at half the old rate becomes two bins, one of each sign.
  if (oversampling > 1 && spectrum.period % 2 == 0) bins.back() /= 2;
  for (auto& bin : bins) bin *= static_cast<double>(oversampling);
  bins.resize(fft.bins());
  std::vector<double> values(fft.length());
  fft.inverse(bins, values);
  values.resize((spectrum.samples - 1) * oversampling + 1);
  return values;
}

void keep_band(PaddedSpectrum& spectrum, const spatial::Band& band) {
  for (std::size_t k = 0; k < spectrum.bins.size(); ++k) {
    const double frequency_hz = spectrum.frequency_hz(k);
    const double beside = std::max((band.low_hz - frequency_hz) / (kLowSkirt * band.low_hz),
                                   (frequency_hz - band.high_hz) / (kHighSkirt * band.high_hz));
    spectrum.bins[k] *= schema::falling_cosine(std::numbers::pi * std::clamp(beside, 0.0, 1.0));
  }
}

PaddedSpectrum through(const PaddedSpectrum& spectrum, const Response& response) {
  PaddedSpectrum result = spectrum;
  for (std::size_t k = 0; k < result.bins.size(); ++k)
    if (result.bins[k] != 0.0) result.bins[k] *= response(result.frequency_hz(k));
  return result;
}

double energy_in(const PaddedSpectrum& spectrum, const spatial::Band& band) {
  double energy = 0;
  for (std::size_t k = 0; k < spectrum.bins.size(); ++k)
    if (band.contains(spectrum.frequency_hz(k))) energy += std::norm(spectrum.bins[k]);
  return energy;
}

}  // namespace tacto::playback

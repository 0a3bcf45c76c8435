// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/fourier_filter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::spatial {
namespace {

// A bin at the band's edge passes in spite of the rounding of its frequency.
constexpr double kOnTheEdge = 1e-12;
// The share of a bin that passes: all or nothing, as the paper truncates.
struct WholeBins {
  Band inclusive;
  explicit WholeBins(Band band)
      : inclusive{band.low_hz * (1 - kOnTheEdge), band.high_hz * (1 + kOnTheEdge)} {}
  double operator()(double frequency_hz) const { return inclusive.contains(frequency_hz) ? 1 : 0; }
};

void shape(std::span<std::complex<double>> spectrum, double bin_hz, const WholeBins& share,
           const SpectralGain& gain) {
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double frequency_hz = static_cast<double>(k) * bin_hz, passes = share(frequency_hz);
    spectrum[k] *= passes;
    if (gain && passes > 0) spectrum[k] *= gain(frequency_hz);
  }
}

std::vector<double> truncated(std::span<const double> values, double sample_rate_hz, Band band,
                              const SpectralGain& gain) {
  RealFft fft(values.size());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(values, spectrum);
  shape(spectrum, sample_rate_hz / static_cast<double>(values.size()), WholeBins(band), gain);
  std::vector<double> filtered(values.size());
  fft.inverse(spectrum, filtered);
  return filtered;
}

}  // namespace

std::vector<double> fourier_filter(std::span<const double> values, double sample_rate_hz, Band band,
                                   Edges edges, const SpectralGain& gain) {
  assert(sample_rate_hz > 0);
  if (values.empty()) return {};
  if (edges == Edges::none) return truncated(values, sample_rate_hz, band, gain);
  BlockFourierFilter filter(sample_rate_hz, band, gain, values.size());
  std::vector<double> filtered;
  filtered.reserve(values.size());
  filter.push(values, filtered);
  filter.finish(filtered);
  return filtered;
}

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier_filter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "spatial/dsp/fft.hpp"

namespace tacto::spatial {
namespace {

// A bin that lies on the band's edge stays, whatever the rounding of its frequency.
constexpr double kOnTheEdge = 1e-12;
// The treated record is transformed as one that lasts so many periods of the lowest frequency, where that is
// not more than kMostPadding times its own length: the finer the bins, the less their place matters.
constexpr double kFinePeriods = 400;
constexpr double kMostPadding = 4;

// How much of a bin passes: all or nothing of each, as the paper truncates.
struct WholeBins {
  Band inclusive;
  explicit WholeBins(Band band)
      : inclusive{band.low_hz * (1 - kOnTheEdge), band.high_hz * (1 + kOnTheEdge)} {}
  double operator()(double frequency_hz) const { return inclusive.contains(frequency_hz) ? 1 : 0; }
};

// The share of the bin's width that lies in the band: what passes then does not depend on where bins happen
// to lie.
struct SharedBins {
  Band band;
  double bin_hz, highest_hz;
  double operator()(double frequency_hz) const {
    const double above = band.low_hz > 0 ? (frequency_hz - band.low_hz) / bin_hz + 0.5 : 1;
    const double below = band.high_hz < highest_hz ? (band.high_hz - frequency_hz) / bin_hz + 0.5 : 1;
    return std::clamp(above, 0.0, 1.0) * std::clamp(below, 0.0, 1.0);
  }
};

template <class Share>
void shape(std::span<std::complex<double>> spectrum, double bin_hz, const Share& share,
           const SpectralGain& gain) {
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double frequency_hz = static_cast<double>(k) * bin_hz, passes = share(frequency_hz);
    spectrum[k] *= passes;
    if (gain && passes > 0) spectrum[k] *= gain(frequency_hz);
  }
}

template <class Share>
void filter_periodic(std::span<double> values, double bin_hz, const Share& share, const SpectralGain& gain) {
  RealFft fft(values.size());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(values, spectrum);
  shape(spectrum, bin_hz, share, gain);
  fft.inverse(spectrum, values);
}

std::size_t treated_length(std::size_t shortest, double low_hz, double sample_rate_hz) {
  const double least = static_cast<double>(shortest);
  const double fine = low_hz > 0 ? kFinePeriods / low_hz * sample_rate_hz : least;
  return fast_length(static_cast<std::size_t>(std::clamp(fine, least, kMostPadding * least)));
}

}  // namespace

std::vector<double> fourier_filter(std::span<const double> values, double sample_rate_hz, Band band,
                                   Edges edges, const SpectralGain& gain) {
  assert(sample_rate_hz > 0);
  const std::size_t n = values.size();
  const auto bin_hz = [&](std::size_t length) { return sample_rate_hz / static_cast<double>(length); };
  if (n == 0) return {};
  if (edges == Edges::none || n == 1) {
    std::vector<double> filtered(values.begin(), values.end());
    filter_periodic(filtered, bin_hz(n), WholeBins(band), gain);
    return filtered;
  }
  const EndTreatment treatment = EndTreatment::for_lowest(band.low_hz, sample_rate_hz, n);
  const std::size_t length = treated_length(n + 2 * treatment.padding, band.low_hz, sample_rate_hz);
  std::vector<double> extended = extend_ends(values, treatment, length);
  filter_periodic(extended, bin_hz(length), SharedBins{band, bin_hz(length), sample_rate_hz / 2}, gain);
  const auto first = extended.begin() + static_cast<std::ptrdiff_t>(treatment.padding);
  return {first, first + static_cast<std::ptrdiff_t>(n)};
}

}  // namespace tacto::spatial

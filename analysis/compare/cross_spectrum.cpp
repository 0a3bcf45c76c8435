// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/cross_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/dsp/spectrum/window.hpp"

namespace tacto::analysis {
namespace {

using Bins = std::vector<std::complex<double>>;

// The windowed and scaled spectra of a signal's segments, one after the other; only the requested bins.
class Segments {
 public:
  Segments(double pitch, std::size_t window, std::size_t first, std::size_t bins)
      : fft_(window),
        first_(first),
        bins_(bins),
        weights_(spatial::hann(window)),
        frame_(window),
        spectrum_(fft_.bins()) {
    const double power = std::inner_product(weights_.begin(), weights_.end(), weights_.begin(), 0.0);
    scale_ = std::sqrt(pitch / power);
  }

  Bins of(std::span<const double> values) {
    Bins rows;
    const std::size_t window = weights_.size(), hop = window - window / 2;
    for (std::size_t from = 0; from + window <= values.size(); from += hop)
      add_row(values.subspan(from, window), rows);
    return rows;
  }

 private:
  void add_row(std::span<const double> part, Bins& rows) {
    const double mean = std::accumulate(part.begin(), part.end(), 0.0) / static_cast<double>(part.size());
    for (std::size_t n = 0; n < part.size(); ++n) frame_[n] = weights_[n] * (part[n] - mean);
    fft_.forward(frame_, spectrum_);
    for (std::size_t k = first_; k < first_ + bins_; ++k) {
      const bool twin = k != 0 && 2 * k != weights_.size();  // the negative frequency has the same power
      rows.push_back(scale_ * (twin ? std::numbers::sqrt2 : 1.0) * spectrum_[k]);
    }
  }

  spatial::RealFft fft_;
  std::size_t first_, bins_;
  std::vector<double> weights_, frame_;
  Bins spectrum_;
  double scale_ = 0;
};

std::vector<double> powers(const Bins& rows) {
  std::vector<double> out(rows.size());
  std::ranges::transform(rows, out.begin(), [](const auto& x) { return std::norm(x); });
  return out;
}

template <class Value>
std::vector<Value> mean_rows(const std::vector<Value>& rows, std::size_t bins) {
  std::vector<Value> mean(bins);
  for (std::size_t i = 0; i < rows.size(); ++i) mean[i % bins] += rows[i];
  const double count = static_cast<double>(rows.size()) / static_cast<double>(bins);
  for (Value& value : mean) value /= count;
  return mean;
}

}  // namespace

double width_of_bin(double frequency, double step, double low, double high) {
  return std::max(0.0, std::min(high, frequency + 0.5 * step) - std::max(low, frequency - 0.5 * step));
}

SegmentSpectra segment_spectra(std::span<const double> a, std::span<const double> b, bool paired,
                               double pitch, std::size_t window, double low, double high) {
  SegmentSpectra spectra;
  spectra.step = 1 / (static_cast<double>(window) * pitch);
  spectra.first = static_cast<std::size_t>(std::lround(low / spectra.step));
  const auto last = std::min(window / 2, static_cast<std::size_t>(std::lround(high / spectra.step)));
  spectra.first = std::min(spectra.first, last);
  spectra.bins = last - spectra.first + 1;
  Segments segments(pitch, window, spectra.first, spectra.bins);
  const Bins of_a = segments.of(a), of_b = segments.of(b);
  spectra.segments_a = of_a.size() / spectra.bins;
  spectra.segments_b = of_b.size() / spectra.bins;
  spectra.aa = powers(of_a);
  spectra.bb = powers(of_b);
  if (!paired) return spectra;
  spectra.ab.resize(of_a.size());
  std::ranges::transform(of_a, of_b, spectra.ab.begin(),
                         [](const auto& x, const auto& y) { return std::conj(x) * y; });
  return spectra;
}

CrossSpectrum mean_of(const SegmentSpectra& spectra) {
  CrossSpectrum mean{spectra.step,
                     {},
                     mean_rows(spectra.aa, spectra.bins),
                     mean_rows(spectra.bb, spectra.bins),
                     mean_rows(spectra.ab, spectra.bins),
                     std::vector<double>(spectra.bins, 0.0)};
  for (std::size_t k = 0; k < spectra.bins; ++k) mean.frequency.push_back(spectra.frequency(k));
  if (spectra.ab.empty()) return mean;
  for (std::size_t k = 0; k < spectra.bins; ++k)
    if (const double power = mean.aa[k] * mean.bb[k]; power > 0)
      mean.coherence[k] = std::min(1.0, std::norm(mean.ab[k]) / power);
  return mean;
}

double independent_segments(std::size_t segments) {
  const auto n = static_cast<double>(segments);
  return segments == 0 ? 0 : n / (1 + 2.0 / 36 * (n - 1) / n);
}

double chance_coherence(double independent) {
  return independent < 2 ? 1 : 1 - std::pow(0.05, 1 / (independent - 1));
}

}  // namespace tacto::analysis

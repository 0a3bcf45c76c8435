// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/band_sums.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

constexpr double kLeastRatio = 1e-30;  // equal to rounding: -300 dB, not -infinity

double ratio_db(double part, double whole) {
  return 10 * std::log10(std::max(part / whole, kLeastRatio));
}

void add_column(std::vector<double>& column, const std::vector<double>& density,
                const SegmentSpectra& spectra, double low, double high) {
  for (std::size_t row = 0; row < density.size() / spectra.bins; ++row) {
    double power = 0;
    for (std::size_t k = 0; k < spectra.bins; ++k)
      power += density[row * spectra.bins + k] * spectra.width(k, low, high);
    column.push_back(power);
  }
}

void transpose(std::vector<double>& columns, std::size_t bands) {
  const std::size_t rows = columns.size() / bands;
  std::vector<double> out(columns.size());
  for (std::size_t b = 0; b < bands; ++b)
    for (std::size_t row = 0; row < rows; ++row) out[row * bands + b] = columns[b * rows + row];
  columns = std::move(out);
}

}  // namespace

double BandSums::error_db() const {
  return ratio_db(aa + bb - 2 * real_ab, aa);
}

double BandSums::residual_db(double gain) const {
  return ratio_db(bb + gain * gain * aa - 2 * gain * real_ab, bb);
}

BandSums band_sums(const CrossSpectrum& mean, const SegmentSpectra& spectra, double low, double high) {
  BandSums sums;
  sums.paired = !mean.ab.empty();
  for (std::size_t k = 0; k < spectra.bins; ++k) {
    const double width = spectra.width(k, low, high);
    sums.aa += mean.aa[k] * width;
    sums.bb += mean.bb[k] * width;
    if (!sums.paired) continue;
    sums.real_ab += mean.ab[k].real() * width;
    sums.coherent_share += mean.aa[k] * mean.coherence[k] * width;
  }
  return sums;
}

void add_band(BandPowers& powers, const SegmentSpectra& spectra, double low, double high) {
  add_column(powers.a, spectra.aa, spectra, low, high);
  add_column(powers.b, spectra.bb, spectra, low, high);
}

void by_segment(BandPowers& powers) {
  transpose(powers.a, powers.bands);
  transpose(powers.b, powers.bands);
}

}  // namespace tacto::analysis

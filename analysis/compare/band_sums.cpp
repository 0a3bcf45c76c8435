// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/band_sums.hpp"

#include "data-schema/base/decibels.hpp"

#include <algorithm>
#include <complex>
#include <numbers>

namespace tacto::analysis {
namespace {

constexpr double kLeastRatio = 1e-30;  // equal signals: -300 dB, not -infinity

double ratio_db(double part, double whole) {
  return schema::power_db(std::max(part / whole, kLeastRatio));
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

BandSums band_sums(const CrossSpectrum& mean, double low, double high) {
  BandSums sums;
  sums.paired = !mean.ab.empty();
  for (std::size_t k = 0; k < mean.frequency.size(); ++k) {
    const double width = mean.width(k, low, high);
    sums.aa += mean.aa[k] * width;
    sums.bb += mean.bb[k] * width;
    if (!sums.paired) continue;
    sums.real_ab += mean.ab[k].real() * width;
    sums.coherent_share += mean.aa[k] * mean.coherence[k] * width;
  }
  return sums;
}

ShiftedError shifted_error(const CrossSpectrum& mean, double low, double high, double range) {
  const BandSums sums = band_sums(mean, low, high);
  const auto common = [&](double shift) {
    double sum = 0;
    for (std::size_t k = 0; k < mean.frequency.size(); ++k)
      sum += mean.width(k, low, high) *
             (mean.ab[k] * std::polar(1.0, 2 * std::numbers::pi * mean.frequency[k] * shift)).real();
    return sum;
  };
  constexpr int kSteps = 100;
  double best = 0, most = common(0);
  for (const double step : {range / kSteps, range / (kSteps * kSteps)}) {
    const double middle = best;
    for (int i = -kSteps; i <= kSteps; ++i)
      if (const double sum = common(middle + i * step); sum > most) most = sum, best = middle + i * step;
  }
  return {best, ratio_db(sums.aa + sums.bb - 2 * most, sums.aa)};
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

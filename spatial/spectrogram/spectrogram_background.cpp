// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/spectrogram_background.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "spatial/numbers/robust_statistics.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

using schema::Spectrogram;

constexpr double kFloorGuard =
    3.5;  // unpadded bins: half of Blackman's main lobe is 3, and half a lattice step
constexpr double kFloorReach = 16;   // unpadded bins
constexpr double kAlong = 1.5;       // windows
constexpr std::size_t kFewest = 24;  // cells for a median
constexpr std::size_t kTrendPoints = 64;

std::size_t at_least_one(double count) {
  return static_cast<std::size_t>(std::max(1.0, std::round(count)));
}

// Bins evenly spaced in the logarithm, so that the many high bins do not dominate the slope.
std::vector<std::size_t> spread_bins(std::size_t first, std::size_t end) {
  std::vector<std::size_t> bins;
  for (std::size_t i = 0; i < kTrendPoints; ++i) {
    const double part = static_cast<double>(i) / (kTrendPoints - 1);
    const double bin = static_cast<double>(first) *
                       std::pow(static_cast<double>(end - 1) / static_cast<double>(first), part);
    const auto rounded = static_cast<std::size_t>(std::lround(bin));
    if (bins.empty() || bins.back() != rounded) bins.push_back(rounded);
  }
  return bins;
}

// The exponent a of k^a, fitted to the mean spectrum.
double exponent_of(const Spectrogram& spectrogram, std::span<const BinRange> known) {
  BinRange widest{spectrogram.bins, 0};
  for (const BinRange& row : known) {
    if (row.first >= row.end) continue;
    widest = {std::min(widest.first, row.first), std::max(widest.end, row.end)};
  }
  if (widest.first == 0 || widest.first + 2 > widest.end) return 0;
  const auto mean = mean_spectrum(spectrogram);
  std::vector<double> x;
  std::vector<double> y;
  for (const std::size_t bin : spread_bins(widest.first, widest.end)) {
    if (!(mean[bin] > 0)) continue;
    x.push_back(std::log(static_cast<double>(bin)));
    y.push_back(std::log(mean[bin]));
  }
  return robust_slope(x, y);
}

}  // namespace

SpectrogramBackground::SpectrogramBackground(const Spectrogram& spectrogram, std::span<const BinRange> known)
    : known_(known.begin(), known.end()), rows_(spectrogram.position_m.size()), bins_(spectrogram.bins) {
  unpadded_bin_ = 1 / (spectrogram.window_m * spectrogram.frequency_step_per_m);
  window_rows_ = spectrogram.window_m / spectrogram.hop_m;
  rows_apart_ = at_least_one(window_rows_ / 4);
  bins_apart_ = at_least_one(unpadded_bin_);
  lattice_bins_ = 1 + (bins_ - 1) / bins_apart_;
  whiten(spectrogram);
  for (std::size_t row = 0; row < rows_; row += rows_apart_)
    for (std::size_t bin = 0; bin < bins_; bin += bins_apart_)
      lattice_.push_back(median_around(row, bin) / std::numbers::ln2);
}

void SpectrogramBackground::whiten(const Spectrogram& spectrogram) {
  const double exponent = exponent_of(spectrogram, known_);
  for (std::size_t bin = 0; bin < bins_; ++bin)
    trend_.push_back(std::pow(static_cast<double>(std::max<std::size_t>(bin, 1)), exponent));
  whitened_.assign(rows_ * bins_, 0);
  for (std::size_t row = 0; row < rows_; ++row) whiten_row(spectrogram, row);
}

void SpectrogramBackground::whiten_row(const Spectrogram& spectrogram, std::size_t row) {
  BinRange& known = known_[row];
  const std::span cells = std::span(whitened_).subspan(row * bins_, bins_);
  for (std::size_t bin = known.first; bin < known.end; ++bin)
    cells[bin] = static_cast<float>(static_cast<double>(spectrogram.at(row, bin)) / trend_[bin]);
  cells_.assign(cells.begin() + static_cast<std::ptrdiff_t>(known.first),
                cells.begin() + static_cast<std::ptrdiff_t>(known.end));
  row_gain_.push_back(median_of(cells_));
  // A row of zeros has no background, so none of its bins is used.
  if (!(row_gain_[row] > 0)) known.end = known.first;
  for (std::size_t bin = known.first; bin < known.end; ++bin)
    cells[bin] = static_cast<float>(static_cast<double>(cells[bin]) / row_gain_[row]);
}

double SpectrogramBackground::median_around(std::size_t row, std::size_t bin) {
  const std::size_t along = at_least_one(kAlong * window_rows_);
  const std::size_t stride = at_least_one(window_rows_ / 8);
  const std::size_t guard = at_least_one(std::ceil(kFloorGuard * unpadded_bin_));
  const std::size_t reach = at_least_one(kFloorReach * unpadded_bin_);
  cells_.clear();
  const std::size_t first_row = row > along ? row - along : 0;
  for (std::size_t r = first_row; r < std::min(rows_, row + along + 1); r += stride) {
    const std::size_t from = std::max(known_[r].first, bin > reach ? bin - reach : 0);
    const std::size_t to = std::min(known_[r].end, bin + reach + 1);
    for (std::size_t b = from; b < to; ++b)
      if ((b > bin ? b - bin : bin - b) >= guard) cells_.push_back(whitened_[r * bins_ + b]);
  }
  return cells_.size() < kFewest ? std::numeric_limits<double>::quiet_NaN() : median_of(cells_);
}

double SpectrogramBackground::at(std::size_t row, std::size_t bin) const {
  const std::size_t last_row = (rows_ - 1) / rows_apart_;
  const std::size_t lattice_row = std::min(last_row, (row + rows_apart_ / 2) / rows_apart_);
  const std::size_t lattice_bin = std::min(lattice_bins_ - 1, (bin + bins_apart_ / 2) / bins_apart_);
  return lattice_[lattice_row * lattice_bins_ + lattice_bin] * trend_[bin] * row_gain_[row];
}

}  // namespace tacto::spatial

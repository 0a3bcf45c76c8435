// SPDX-License-Identifier: GPL-3.0-or-later
// The background of a spectrogram: the level that noise alone would have in each cell.
#pragma once

#include <span>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/spectrogram/known_bins.hpp"

namespace tacto::spatial {

/// The expected density of a cell without the line in it, by ordered statistics of its neighbours (Rohling
/// 1983, IEEE Trans. AES 19(4)): the median of the known cells that are within 1.5 windows along position and
/// between 3.5 and 16 bins of the unpadded window (1 / window) away in frequency, over ln 2, because cells of
/// noise have an exponential distribution. Before that, each cell is divided by a power law k^a fitted to the
/// mean spectrum (Theil and Sen's robust slope), and by the median of its row.
class SpectrogramBackground {
 public:
  /// Precondition: one range per row.
  SpectrogramBackground(const schema::Spectrogram& spectrogram, std::span<const BinRange> known);
  /// unit^2 m; NaN if too few neighbours are known.
  double at(std::size_t row, std::size_t bin) const;

 private:
  void whiten(const schema::Spectrogram& spectrogram);
  void whiten_row(const schema::Spectrogram& spectrogram, std::size_t row);
  double median_around(std::size_t row, std::size_t bin);

  std::vector<BinRange> known_;
  std::vector<double> trend_;     // by bin
  std::vector<double> row_gain_;  // by row
  std::vector<float> whitened_;
  std::size_t rows_ = 0, bins_ = 0;
  std::size_t rows_apart_ = 1, bins_apart_ = 1;  // of the lattice on which it is computed
  std::size_t lattice_bins_ = 0;
  std::vector<double> lattice_;
  std::vector<float> cells_;
  double unpadded_bin_ = 1;  // in bins
  double window_rows_ = 1;
};

}  // namespace tacto::spatial

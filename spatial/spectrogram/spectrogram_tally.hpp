// SPDX-License-Identifier: GPL-3.0-or-later
// Summary values of a spectrogram, accumulated row by row.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {

/// Strongest peak and RMS above a frequency that may be chosen after the rows were added: any at or below
/// `settled_per_m`. All bins from there on share one sum, so the size does not depend on that of the
/// spectrogram.
class SpectrogramTally {
 public:
  SpectrogramTally(const schema::SpectrogramHeader& header, double settled_per_m);

  /// Whole rows by increasing position, from row `first` on.
  void add(std::size_t first, std::span<const float> cells);

  /// As strongest_peak() and band_rms() of spectrogram_summary.hpp. Precondition: a row was added.
  SpectralPeak strongest_peak(double min_frequency_per_m) const;
  double band_rms(double min_frequency_per_m) const;

 private:
  struct Peak {
    float cell = -1;
    std::size_t row = 0, bin = 0;
  };
  void add_low(std::size_t row, std::span<const float> cells);
  void add_high(std::size_t row, std::span<const float> cells);

  schema::SpectrogramHeader header_;
  std::size_t first_merged_bin_, rows_ = 0;
  std::vector<double> low_powers_;  // sums over rows, one per bin below first_merged_bin_
  std::vector<Peak> low_peaks_;
  double high_power_ = 0;  // of all bins from first_merged_bin_ on
  Peak high_peak_;
};

}  // namespace tacto::spatial

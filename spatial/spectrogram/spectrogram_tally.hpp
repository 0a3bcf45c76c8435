// SPDX-License-Identifier: GPL-3.0-or-later
// The few numbers that sum up a spectrogram, gathered while its rows go by.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {

/// Strongest peak and RMS above a frequency that need not be known before the rows have gone: any at or under
/// `settled_per_m` may be asked for. Bins from there on are kept as one, so its size does not grow with the
/// spectrogram.
class SpectrogramTally {
 public:
  SpectrogramTally(const schema::SpectrogramHeader& header, double settled_per_m);

  /// Whole rows by growing position, from row `first` on.
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
  std::size_t settled_, rows_ = 0;
  std::vector<double> low_powers_;  // sums over rows, one a bin under settled_
  std::vector<Peak> low_peaks_;
  double high_power_ = 0;  // of all bins from settled_ on
  Peak high_peak_;
};

}  // namespace tacto::spatial

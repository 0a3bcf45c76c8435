// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of one mean spectrum: their frequencies, the uncertainty of these, and their prominence over the
// background.
#pragma once

#include <span>
#include <vector>

namespace tacto::spatial {

/// A line: a peak of a mean spectrum that exceeds the noise.
struct SpectralLine {
  double frequency = 0;      ///< 1/m or Hz
  double sigma = 0;          ///< its standard deviation
  double power = 0;          ///< unit^2: A^2 / 2 of a sine
  double prominence_db = 0;  ///< over the background
};

/// Mean spectrum of evenly spaced values over position or time: Blackman windows of half the values, hops of
/// an eighth of a window, zero padded to at least twice their length (Welch 1967). The background at each bin
/// is the median of the bins between 3.5 and 16 unpadded bins away, after a power law has been removed. It is
/// converted from median to mean for the number of independent windows (Wilson and Hilferty 1931).
class LineSpectrum {
 public:
  /// Lines are searched between `low` and `high`, in 1/unit of `pitch`, except for one resolution at both
  /// ends: at the edge of a band-pass every slope has a maximum. Precondition: at least kFewestValues values,
  /// all finite.
  LineSpectrum(std::span<const double> values, double pitch, double low, double high);

  static constexpr std::size_t kFewestValues = 64;

  /// Sorted by frequency; all reach needed_db(). The standard deviation of a frequency is the Cramer-Rao
  /// bound of a sine in white noise, times 1.8 for the window, or a tenth of the half-power width, whichever
  /// is larger.
  const std::vector<SpectralLine>& lines() const { return lines_; }
  /// Prominence that noise alone reaches in one cell of 10,000.
  double needed_db() const { return needed_db_; }
  /// Lines closer than this are not resolved: 1.7268 / window (Harris 1978).
  double resolution() const { return resolution_; }
  double low() const { return low_; }
  double high() const { return high_; }
  bool knows(double frequency) const { return low_ <= frequency && frequency <= high_; }
  /// The prominence of a sine of this power at a frequency; -infinity where the background is not known.
  double prominence_db(double power, double frequency) const;
  /// Lines per unit of frequency around a frequency: those within an octave to each side, and one more.
  double clutter(double frequency) const;

 private:
  void find_background(const std::vector<double>& mean, double step);
  void find_lines(const std::vector<double>& mean, double step);
  double background_at(double frequency) const;

  double low_ = 0, high_ = 0, step_ = 0, window_ = 0;
  double resolution_ = 0, needed_db_ = 0, looks_ = 1;
  std::size_t first_bin_ = 0;
  std::vector<double> background_;  // from first_bin_ on
  std::vector<SpectralLine> lines_;
};

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// Welch's power spectral density: the mean over half-overlapping Hann windows (Welch 1967, IEEE Trans. Audio
// Electroacoustics 15(2)). Offline; not safe in the tick.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

inline constexpr std::size_t kShortestWelchWindow = 8;

/// One-sided density of evenly spaced values, each window without its mean, the same as scipy.signal.welch(x,
/// 1 / pitch, 'hann', W). Values after the last whole window are not used.
class WelchSpectrum {
 public:
  /// Precondition: kShortestWelchWindow <= window <= values.size(). `pitch` in metres or seconds.
  WelchSpectrum(std::span<const double> values, double pitch, std::size_t window);

  /// unit^2 per unit of frequency, one value per bin.
  const std::vector<double>& density() const { return density_; }
  double step() const { return step_; }
  /// Number of averaged windows.
  std::size_t windows() const { return windows_; }

  /// Integrals of S and of k S; the density is constant within half a bin of each bin. Precondition: 0 <=
  /// from <= to <= half the sampling frequency.
  double power(double from, double to) const { return integral(from, to, false); }
  double moment(double from, double to) const { return integral(from, to, true); }

 private:
  double integral(double from, double to, bool weighted) const;

  std::vector<double> density_;
  double step_ = 0;
  std::size_t windows_ = 0;
};

}  // namespace tacto::spatial

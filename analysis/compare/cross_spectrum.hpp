// SPDX-License-Identifier: GPL-3.0-or-later
// Power and cross spectra of two signals for each segment, so that a common signal can be distinguished from
// chance.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tacto::analysis {

/// Width of the part of a bin within [low, high].
double width_of_bin(double frequency, double step, double low, double high);

/// Welch's spectra (Welch 1967: half-overlapping Hann windows, the mean of each segment removed; one-sided)
/// of the bins that overlap [low, high]. In unit^2 per unit of frequency; one row per segment. The mean over
/// the rows is scipy.signal.welch and csd(x, y, 1 / pitch, 'hann', W). Bin k covers [k - 1/2, k + 1/2] steps.
struct SegmentSpectra {
  double step = 0;        ///< between bins
  std::size_t first = 0;  ///< number of the first kept bin
  std::size_t bins = 0;
  std::size_t segments_a = 0, segments_b = 0;  ///< equal if the signals are paired
  std::vector<double> aa, bb;                  ///< one segment after the other, `bins` values each
  std::vector<std::complex<double>> ab;        ///< conj(A) B; empty if the signals are not paired

  double frequency(std::size_t k) const { return static_cast<double>(first + k) * step; }
  double width(std::size_t k, double low, double high) const {
    return width_of_bin(frequency(k), step, low, high);
  }
};

/// Preconditions: 8 <= window <= both sizes; equal sizes if `paired`; 0 <= low < high.
SegmentSpectra segment_spectra(std::span<const double> a, std::span<const double> b, bool paired,
                               double pitch, std::size_t window, double low, double high);

/// Means over all segments, at each bin.
struct CrossSpectrum {
  double step = 0;
  std::vector<double> frequency, aa, bb;
  std::vector<std::complex<double>> ab;
  std::vector<double> coherence;  ///< |ab|^2 / (aa bb), magnitude-squared; 0 without power

  double width(std::size_t k, double low, double high) const {
    return width_of_bin(frequency[k], step, low, high);
  }
};
CrossSpectrum mean_of(const SegmentSpectra& spectra);

/// Equivalent number of independent segments for half-overlapping Hann windows: n / (1 + 2 (1/6)^2 (n - 1) /
/// n), because in white noise the periodograms of neighbours have a correlation of 1/36 (Welch 1967, equation
/// 16).
double independent_segments(std::size_t segments);

/// The magnitude-squared coherence that independent signals exceed by chance once in 20 times, at a bin of n
/// independent segments: 1 - 0.05^(1 / (n - 1)) (Carter, Knapp and Nuttall 1973, IEEE Trans. Audio
/// Electroacoustics 21(4)). 1 for fewer than 2.
double chance_coherence(double independent);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the band in which two textures differ most, and the spectral line that only one of them has, over
// their whole length; compares both with chance.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/compare/cross_spectrum.hpp"

namespace tacto::analysis {

struct SpectralLine {
  double frequency_per_m = 0;
  bool in_b = false;         ///< whether B has the line, otherwise A
  double level_db = 0;       ///< line and noise over noise; densities in a Hann window of `window` samples
  double score = 0;          ///< power of its bin over the mean power of bins nearby: the largest of all
  double chance_score = 0;   ///< exceeded by 0.5 % of the pairs of steady textures of the same kind
  double detectable_db = 0;  ///< level of a line that is found in 8 of 10 pairs of steady textures
};

/// A maximum statistic over all frequencies, at half bins of the whole length of the shorter texture (both
/// from their starts), with a cosine taper of an eighth at each end. The power of A is divided by the larger
/// of two: the smooth density of both (mean of the logarithm over 24 bins to each side, at A's level), and
/// the mean power of B over 4 bins to each side; the power of B likewise. So a peak in both, or a line in
/// both that moved by less than 4 bins, is not a difference. Returns no value for fewer than 30 bins in [low,
/// high]. Preconditions: some power in both, 0 <= low < high.
std::optional<SpectralLine> strongest_line(std::span<const double> a, std::span<const double> b, double pitch,
                                           double low, double high, double window);

/// A difference in level over a band that is found, and exceeds the tolerance, in 8 of 10 pairs of steady
/// textures.
struct DetectableBand {
  double width_per_m = 0;
  double level_db = 0;
};

struct NarrowBand {
  double low_per_m = 0, high_per_m = 0;
  double level_db = 0;  ///< B over A in the band, relative to the mean level over all cells
  double score = 0;  ///< |level_db| over its standard error: the largest of the bands beyond the tolerance,
                     ///< or of all bands if none is beyond it
  double chance_score = 0;  ///< exceeded by 4.5 % of the pairs of steady textures of the same kind
  std::vector<DetectableBand> detectable;  ///< by growing width
};

/// A maximum (scan) statistic over all bands of 1, 2, 3, 4, 6, 8, 12, 16, 24 and 32 cells, up to half of all;
/// a cell is a bin of Welch's spectra, 1 / window wide. The cells are divided by a smooth mean density of
/// both textures, so that they have equal weights. The standard error of a band's level is the larger of two:
/// the exact one of steady Gaussian noise (log of a ratio of gamma variables; Welch 1967 for the overlap),
/// and the jackknife's over segments (Efron 1979), averaged over all bands of that width; the second is
/// larger if the textures are not stationary. Returns no value for fewer than 6 cells in [low, high] or 2
/// segments. Precondition: some power in both.
std::optional<NarrowBand> strongest_band(const SegmentSpectra& spectra, double low, double high,
                                         double tolerance_db);

}  // namespace tacto::analysis

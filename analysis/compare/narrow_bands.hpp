// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the band in which two textures differ most, and compares that difference with chance.
#pragma once

#include <optional>
#include <vector>

#include "analysis/compare/cross_spectrum.hpp"

namespace tacto::analysis {

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

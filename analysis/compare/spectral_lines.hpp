// SPDX-License-Identifier: GPL-3.0-or-later
// Finds a spectral line that only one of two textures has, over their whole length.
#pragma once

#include <optional>
#include <span>

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

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// The line that one of two textures has and the other does not, over their whole length.
#pragma once

#include <optional>
#include <span>

namespace tacto::analysis {

struct SpectralLine {
  double frequency_per_m = 0;
  bool in_b = false;         ///< in which of the two
  double level_db = 0;       ///< line and noise over noise, densities in a Hann window of `window` samples
  double score = 0;          ///< its power in a bin over the mean power of a bin there: the largest of all
  double chance_score = 0;   ///< exceeded by 0.5 % of the pairs of steady textures of one kind
  double detectable_db = 0;  ///< level of a line that is found in 8 of 10 pairs of steady textures
};

/// A maximum statistic over all frequencies, at half bins of the whole length of the shorter (from both
/// starts), under a cosine taper of an eighth at each end. The power of A is divided by the larger of two:
/// the smooth density of both (mean of the logarithm over 24 bins to each side, at A's level), and the mean
/// power of B over 4 bins to each side; so is B's. A line that both have, moved by less than 4 bins, or a
/// peak that both have, is no difference. Preconditions: some power in both, 0 <= low < high. Without a value
/// for less than 30 bins in [low, high].
std::optional<SpectralLine> strongest_line(std::span<const double> a, std::span<const double> b, double pitch,
                                           double low, double high, double window);

}  // namespace tacto::analysis

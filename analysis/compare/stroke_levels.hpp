// SPDX-License-Identifier: GPL-3.0-or-later
// The spectrum of one stroke as levels in one-sixth-octave bands.
#pragma once

#include <span>
#include <vector>

namespace tacto::analysis {

/// Edges of the whole one-sixth-octave bands within [low_per_m, high_per_m], one more than bands: G^(x/6) /
/// mm for integers x, G = 10^0.3 (IEC 61260-1:2014, 5.2 to 5.5, base 10, reference frequency 1 /mm); two
/// adjacent bands are a one-third-octave band. Empty if no band is whole. Precondition: 0 < low_per_m,
/// finite.
std::vector<double> sixth_octave_edges(double low_per_m, double high_per_m);

/// Power of `values` less their mean in each band, in dB re 1 unit^2: the mean of the periodograms with four
/// sine tapers (Riedel and Sidorenko 1995, IEEE Trans. Signal Processing 43(1)), w_k(n) = sqrt(2 / (N + 1))
/// sin(pi k n / (N + 1)), integrated with a constant density within half a bin around each bin. A level is at
/// least the largest less 60 dB. Empty if there is no power in any band. Preconditions: at least 8 values, at
/// least two edges, the last at most half the frequency of the grid.
std::vector<double> stroke_levels_db(std::span<const double> values, double pitch_m,
                                     std::span<const double> edges_per_m);

}  // namespace tacto::analysis

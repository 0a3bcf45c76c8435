// SPDX-License-Identifier: GPL-3.0-or-later
// Decimation for a short-time transform that keeps the values of its bins: the parameters.
#pragma once

#include <cstddef>
#include <string>

namespace tacto::spatial {

/// Windows of a short-time transform, in samples. `bins` is the number of bins that are kept, from zero
/// frequency.
struct FrameShape {
  std::size_t window = 0, hop = 0, padded = 0, bins = 0;
};

/// Frames use every `factor`-th sample of a low-passed signal. Their starts are on every `grid`-th sample, so
/// that factor / grid interleaved sequences ("phases") keep a hop that `factor` does not divide.
struct Decimation {
  std::size_t factor = 1;     ///< 1: full resolution
  std::size_t grid = 1;       ///< divides factor and hop
  double pass = 0.5;          ///< everything up to here passes, cycles per sample
  double stop = 0.5;          ///< everything from here on is suppressed: 1 / factor - pass
  std::string whole_because;  ///< why full resolution, if no coarser grid was found
};

/// The coarsest grid that keeps the window's leakage. A Blackman window passes a line 50 / window away at
/// -127 dB (Harris 1978: -58 dB at the first side lobe, falling by 18 dB per octave), so the filter passes
/// everything up to 50 / window above the last bin and suppresses what would alias below that. `factor` is
/// the largest divisor of `padded` with 1 / factor >= 3 pass. Full resolution if there is none, or if so few
/// windows share a sample that the filter would cost more than it saves.
Decimation decimation_for(const FrameShape& shape);

/// The stop-band edge of the first filter, down to `grid`: it suppresses what the second one does not, or
/// everything if grid == factor. Cycles per sample.
double coarse_stop(const Decimation& decimation);

}  // namespace tacto::spatial

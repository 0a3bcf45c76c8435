// SPDX-License-Identifier: GPL-3.0-or-later
// How a short-time transform may work on a coarser grid and still give the same bins, as numbers.
#pragma once

#include <cstddef>
#include <string>

namespace tacto::spatial {

/// Windows of a short-time transform, in samples. `bins` counts those that are kept, from zero frequency.
struct FrameShape {
  std::size_t window = 0, hop = 0, padded = 0, bins = 0;
};

/// Frames take every `factor`-th sample of a low-passed signal; their starts lie on every `grid`-th sample,
/// so that factor / grid interleaved sequences ("phases") keep a hop that `factor` does not divide.
struct Decimation {
  std::size_t factor = 1;     ///< 1: whole resolution
  std::size_t grid = 1;       ///< divides factor and hop
  double pass = 0.5;          ///< all up to here is passed, cycles a sample
  double stop = 0.5;          ///< all from here on is suppressed: 1 / factor - pass
  std::string whole_because;  ///< why whole resolution, where a coarser grid was looked for in vain
};

/// The coarsest grid that keeps the window's leakage: a Blackman window lets through a line 50 / window away
/// at -127 dB (Harris 1978: -58 dB at the first side lobe, falling by 18 dB an octave), so the filter passes
/// all up to 50 / window above the last bin and suppresses what would fold back under that. `factor` is the
/// largest divisor of `padded` with 1 / factor >= 3 pass. Whole resolution where there is none, or where few
/// windows share a sample so that the filter would cost more than it saves.
Decimation decimation_for(const FrameShape& shape);

/// From where on the first filter, down to `grid`, has to suppress: what the second one would not, or, with
/// grid == factor, all of it. Cycles a sample.
double coarse_stop(const Decimation& decimation);

}  // namespace tacto::spatial

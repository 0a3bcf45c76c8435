// SPDX-License-Identifier: GPL-3.0-or-later
// Removes spatial frequencies that a coarser pitch would alias.
#pragma once

#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/dsp/filter/record_ends.hpp"

namespace tacto::spatial {

/// Share of the samples per metre up to which the windowed sinc interpolates well; above it the gain falls.
inline constexpr double kInterpolatedShare = 0.45;

struct BandLimited {
  std::vector<double> values;
  double removed_share =
      0;  ///< RMS of what was removed re that of all, each about its mean; 0 if nothing was
};

/// The values without what is above `high_per_m` (filter_in_space from 0; Edges::none for values that repeat
/// themselves). They are not filtered if that is less than 1e-5 of their RMS. Precondition: at least
/// kShortestWelchWindow values, 0 < high_per_m < 0.5 / pitch_m. Errors: of filter_in_space.
schema::Result<BandLimited> band_limited(std::span<const double> values, double pitch_m, double high_per_m,
                                         Edges edges);

}  // namespace tacto::spatial

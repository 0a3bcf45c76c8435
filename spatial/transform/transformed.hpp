// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a texture with new values from another one, with its metadata and one more step in its history.
// Internal to this folder.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/record_ends.hpp"

namespace tacto::spatial {

// Removes spatial frequencies that a coarser pitch would alias.

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

/// A texture with new values: grid, quantity, place, surface and notes are the old one's; source, average,
/// certificate and unknown members, which describe the old values, are left out. `step` is added to its
/// transform.
schema::Texture transformed(const schema::Texture& texture, std::vector<double> values,
                            schema::TransformStep step);

}  // namespace tacto::spatial

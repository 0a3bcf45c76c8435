// SPDX-License-Identifier: GPL-3.0-or-later
// A texture with all spatial periods longer or shorter by one factor, at its original length.
#pragma once

#include <optional>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

inline constexpr double kLeastStretch = 0.05, kMostStretch = 20;

struct Stretch {
  double factor = 1;        ///< period in the result / period in the source, kLeastStretch to kMostStretch
  bool keep_slope = false;  ///< values are multiplied by the factor, too, so that amplitude / period stays
  /// periods: the result has whole periods and can be played in a loop. best_fit: it has exactly the
  /// original number of samples. None: periods, where the texture has a period, else best_fit.
  std::optional<schema::Lengthening> lengthening = std::nullopt;
  std::optional<double> period_m = std::nullopt;  ///< of the source; if none, it is found (find_period)
};

/// The texture stretched, on the same grid. With a factor below 1 it is lengthened again: at a joint it
/// continues with an earlier part of itself, as often as necessary. `periods`: the joint is a whole number of
/// periods after that part, and the result has the number of whole periods that is nearest to the original
/// length (with a factor above 1 at most those that there are). `best_fit`: the joint is where value and
/// slope fit best by least squares; of joints whose errors differ by less than 1e-3 the latest one is taken,
/// so that the least of the texture is left out.
///
/// Interpolation is the windowed sinc's: error re the amplitude of a tone below 1e-5 up to 0.4 of the samples
/// per metre. What the grid can't hold after stretching, above 0.45 min(factor, 1) / pitch in the source, is
/// removed before.
///
/// The result has the texture's members except source, average and certificate; its valid band is the
/// stretched one; the last of its transform->steps says what was done, what was lost and how well the joint
/// fits. Errors: usage: a factor out of range, a period that is not above 0; unsuitable: `periods` of a
/// texture without a period (or shorter than two of them), or a texture that is too short to be joined.
schema::Result<schema::Texture> stretch(const schema::Texture& texture, const Stretch& stretch);

}  // namespace tacto::spatial

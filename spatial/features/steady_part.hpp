// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a texture made at steady speed, for which one band is valid.
#pragma once

#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// Largest factor, up or down, between the speed and its median along the texture.
inline constexpr double kSteadyFactor = 1.25;

/// The longest section of a texture at steady speed, and its position.
struct SteadyPart {
  double from_m = 0, to_m = 0;
  schema::Texture texture;  ///< samples and band from from_m on (now position 0); other members unchanged
};

/// The longest run, sampled at 1,000 equidistant positions, in which both limits of the valid band are within
/// kSteadyFactor of their medians. A stroke begins and ends at rest, where its band differs much from the
/// rest. A texture without a band is returned whole. Precondition: at least one sample.
SteadyPart steady_part(const schema::Texture& texture);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a texture in which the finger kept its speed: what one band can be said of.
#pragma once

#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// How far the speed may lie from its median along the texture, as a factor either way.
inline constexpr double kSteadyFactor = 1.25;

/// A texture's longest stretch at steady speed, and where it lay.
struct SteadyPart {
  double from_m = 0, to_m = 0;
  schema::Texture texture;  ///< its samples and band, position 0 at from_m; the rest as it was
};

/// The longest run, seen at 1,000 even places, over which both limits of the valid band stay within
/// kSteadyFactor of their medians: a stroke begins and ends at rest, where its band is far from that of the
/// rest. All of a texture that names no band. Precondition: a sample.
SteadyPart steady_part(const schema::Texture& texture);

}  // namespace tacto::spatial

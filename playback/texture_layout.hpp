// SPDX-License-Identifier: GPL-3.0-or-later
// Textures laid on the encoder's axis as one.
#pragma once

#include <span>

#include "data-schema/signal.hpp"
#include "playback/prepare.hpp"

namespace tacto::playback {

/// One period, or all there is, of what the finger meets; its origin_m is on the encoder's axis.
/// stop: a margin of zeros about textures that fade at their ends (TextureLookup), on the finest grid among
/// them, added where they lie over each other. loop: without its last seam_m, which fades into the first.
/// mirror: as it is.
schema::SpaceSignal laid_out(std::span<const PlacedTexture> textures, Ends ends, double seam_m);
/// The same, counted.
schema::SpaceSignal laid_out(std::span<const PlacedTexture> textures, Ends ends, double seam_m,
                             ConstructionTally& built);

}  // namespace tacto::playback

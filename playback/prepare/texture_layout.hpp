// SPDX-License-Identifier: GPL-3.0-or-later
// Textures laid on the encoder's axis as one.
#pragma once

#include <span>

#include "data-schema/base/signal.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// How much of a looped texture's end fades into its beginning, m: 0 where the end meets the beginning as it
/// is, else seam_m, to whole samples and at most half the texture. It meets where, from the last sample to
/// the first, neither the step in value nor the step in slope (second difference) is larger than the largest
/// ones between neighbours within seam_m (at least 64 samples) of the ends; a twentieth more and what
/// rounding to 32-bit float makes are allowed. The first sample follows the last
/// one a pitch later: it is not to be there twice.
double seam_of_loop(const schema::SpaceSignal& signal, double seam_m);
/// One period: without its last seam_m, which fades into the first by a raised cosine.
schema::SpaceSignal looped(schema::SpaceSignal signal, double seam_m);

/// One period, or all there is, of what the finger meets; its origin_m is on the encoder's axis.
/// stop: a margin of zeros about textures that fade at their ends (TextureLookup), on the finest grid among
/// them, added where they lie over each other. loop: looped() by seam_of_loop().
/// mirror: as it is.
schema::SpaceSignal laid_out(std::span<const PlacedTexture> textures, Ends ends, double seam_m);
/// The same, counted.
schema::SpaceSignal laid_out(std::span<const PlacedTexture> textures, Ends ends, double seam_m,
                             ConstructionTally& built);

/// m, between the first texture and the last, that none of them covers: laid_out() samples it as well.
double way_between(std::span<const PlacedTexture> textures);

}  // namespace tacto::playback

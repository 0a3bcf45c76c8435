// SPDX-License-Identifier: GPL-3.0-or-later
// Places textures on the encoder's axis as one signal.
#pragma once

#include <span>

#include "data-schema/base/signal.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// The length of a looped texture's end that fades into its beginning, m: 0 if the end meets the beginning as
/// it is, else seam_m, rounded to whole samples and at most half the texture. It meets if, from the last
/// sample to the first, neither the step in value nor the step in slope (second difference) is larger than
/// the largest one between neighbours within seam_m (at least 64 samples) of the ends; a twentieth more and
/// the rounding to 32-bit float are allowed. The first sample follows the last one after a pitch, so it must
/// not be there twice.
double seam_of_loop(const schema::SpaceSignal& signal, double seam_m);
/// One period: the last seam_m are removed and fade into the first by a raised cosine.
schema::SpaceSignal looped(schema::SpaceSignal signal, double seam_m);

/// One period, or the whole, of the signal under the finger; its origin_m is on the encoder's axis. stop:
/// textures that fade at their ends (TextureLookup), with a margin of zeros, on the finest grid among them,
/// added where they overlap. loop: looped() by seam_of_loop(). mirror: unchanged.
schema::SpaceSignal one_period(std::span<const PlacedTexture> textures, Ends ends, double seam_m);
/// The same; counts what it builds.
schema::SpaceSignal one_period(std::span<const PlacedTexture> textures, Ends ends, double seam_m,
                               ConstructionTally& built);

/// The length between the first and the last texture that no texture covers, m; one_period() samples it as
/// well.
double uncovered_length_m(std::span<const PlacedTexture> textures);

}  // namespace tacto::playback

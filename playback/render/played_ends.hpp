// SPDX-License-Identifier: GPL-3.0-or-later
// A texture as it is played beyond its ends.
#pragma once

#include <string>

#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// Texture to be looked up with its first sample at at_m.
struct PlayedSignal {
  schema::SpaceSignal signal;
  double at_m = 0;
};

/// What a scene's or session's words mean to prepare().
Ends ends_of(schema::TextureEnds ends);

struct PlayedEnds {
  Ends ends = Ends::stop;
  double seam_m = 0;  ///< of a loop (looped())
};

/// As prepare() makes them where nobody names a seam.
PlayedEnds prepared_ends(const schema::Texture& texture, Ends ends);

/// The texture where it lies; looped or mirrored as far as a finger goes from
/// from_m to to_m, and 5 mm farther: there its ends, which a lookup fades, are not met. `where` names it in
/// errors. Errors: unsuitable: over 2^24 samples.
schema::Result<PlayedSignal> as_played(const schema::Texture& texture, double at_m, const PlayedEnds& ends,
                                       double from_m, double to_m, const std::string& where);

}  // namespace tacto::playback

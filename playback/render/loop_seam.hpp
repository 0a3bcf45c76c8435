// SPDX-License-Identifier: GPL-3.0-or-later
// A texture continued beyond its ends as it is played.
#pragma once

#include <string>

#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// A texture for a lookup with its first sample at at_m.
struct PlayedSignal {
  schema::SpaceSignal signal;
  double at_m = 0;
};

/// The ends of a scene or session as options of prepare().
Ends ends_of(schema::TextureEnds ends);

struct PlayedEnds {
  Ends ends = Ends::stop;
  double seam_m = 0;  ///< of a loop (looped())
};

/// The ends as prepare() makes them if no seam is given.
PlayedEnds prepared_ends(const schema::Texture& texture, Ends ends);

/// The texture at its position; if looped or mirrored, continued from from_m to to_m and 5 mm beyond, because
/// a lookup fades the ends. `where` names the texture in errors. Errors: unsuitable: over 2^24 samples.
schema::Result<PlayedSignal> as_played(const schema::Texture& texture, double at_m, const PlayedEnds& ends,
                                       double from_m, double to_m, const std::string& where);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// A texture as a session played it beyond its ends.
#pragma once

#include "data-schema/session.hpp"
#include "data-schema/texture.hpp"

namespace tacto::playback {

/// Texture to be looked up with its first sample at at_m.
struct PlayedSignal {
  schema::SpaceSignal signal;
  double at_m = 0;
};

/// The texture where it lay; looped (with the seam of prepare()) or mirrored as far as a finger went from
/// from_m to to_m, and 5 mm farther: there its ends, which a lookup fades, are not met. Errors: unsuitable:
/// over 2^24 samples.
schema::Result<PlayedSignal> as_played(const schema::Texture& texture, const schema::SessionTexture& played,
                                       double from_m, double to_m);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether a texture can be played.
#pragma once

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::playback {

/// Errors: unsuitable, for a texture that is not force in N, has fewer than 2 samples, or one (by number)
/// that is not finite.
schema::Result<void> check_playable(const schema::Texture& texture);

}  // namespace tacto::playback

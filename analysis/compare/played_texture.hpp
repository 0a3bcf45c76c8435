// SPDX-License-Identifier: GPL-3.0-or-later
// What a session makes of the tray by the model, as a texture, and what was wanted.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/session/session.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// One stroke of a session: the displacement that the recorded drive makes of the transducer's model (no
/// finger's load, no hysteresis: playback::predicted_displacement_m), m, against the encoder's position.
struct PlayedTexture {
  schema::Texture texture;
  schema::SessionHeader header;         ///< its textures, choices and scene are those of the stroke
  std::size_t stroke = 0, strokes = 0;  ///< 1-based, of so many
  double gain = 1;                      ///< factor on the textures' own gains
};

/// `stroke` is 1-based; 0 takes the longest. Errors: as read_session_stroke, texture_along; unsuitable: a
/// gain or texture that changes within the stroke, or to one that an older session does not name before it.
schema::Result<PlayedTexture> played_texture(const std::string& session, std::size_t stroke,
                                             const std::function<void(double)>& progress = {});

/// A texture as the session's finger was to feel it: force times gain, where it lay. `file` names it, by stem
/// or in full. Errors: unsuitable: not the samples that were played (by SHA-256); not_found.
schema::Result<schema::Texture> target_of(const schema::Texture& texture, const std::string& file,
                                          const PlayedTexture& played);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Textures of a session: the displacement of the tray by the model, and its target.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/session/session.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// One stroke of a session: the displacement, m, that the transducer's model gives for the recorded drive
/// (without a finger's load, without hysteresis: playback::predicted_displacement_m), against the encoder's
/// position.
struct PlayedTexture {
  schema::Texture texture;
  schema::SessionHeader header;         ///< its textures, choices and scene apply to the stroke
  std::size_t stroke = 0, strokes = 0;  ///< 1-based number, and the number of all
  double gain = 1;                      ///< on the textures' own gains
};

/// `stroke` is 1-based; 0 selects the longest. Errors: those of read_session_stroke and texture_along;
/// unsuitable: a gain or texture that changes within the stroke, or a change to a texture whose
/// description the session lacks.
schema::Result<PlayedTexture> played_texture(const std::string& session, std::size_t stroke,
                                             const std::function<void(double)>& progress = {});

/// The target of the session's finger for this texture: force times gain, at its place in the session. `file`
/// is its path or stem. Errors: unsuitable: the samples are not those that were played (by SHA-256);
/// not_found.
schema::Result<schema::Texture> target_of(const schema::Texture& texture, const std::string& file,
                                          const PlayedTexture& played);

}  // namespace tacto::analysis

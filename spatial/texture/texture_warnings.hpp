// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about the quality of a texture.
#pragma once

#include <string>
#include <vector>

#include "data-schema/texture/texture.hpp"
#include "spatial/texture/make_texture.hpp"

namespace tacto::spatial {

/// Warnings of many textures are grouped by `kind`; `size` selects the worst of them.
struct TextureWarning {
  std::string text;
  const char* kind = "";
  double size = 0;
};

/// At most one of each kind: conditioning moved positions by more than two quanta (a count may flicker) and 6
/// standard deviations of their noise explain (the finger moved backwards); the band's upper limit, at the
/// mean speed, is above the highest frequency of the grid; a counter overflowed.
std::vector<TextureWarning> texture_warnings(const schema::Texture& texture);

/// The chosen channel, if the options name none and there is no tangential_force; otherwise empty.
std::string channel_note(const TextureOptions& options, const TouchRecord& record);

/// The loss, if a method loses part of the requested band at this rate; otherwise empty.
std::string rate_warning(const TextureOptions& options, double sample_rate_hz);

}  // namespace tacto::spatial

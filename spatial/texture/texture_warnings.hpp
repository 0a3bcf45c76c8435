// SPDX-License-Identifier: GPL-3.0-or-later
// What a user should know of a texture before trusting it.
#pragma once

#include <string>
#include <vector>

#include "data-schema/texture/texture.hpp"
#include "spatial/texture/make_texture.hpp"

namespace tacto::spatial {

/// `kind` and `size` tell alike warnings of many textures together, and which of them is the worst.
struct TextureWarning {
  std::string text;
  const char* kind = "";
  double size = 0;
};

/// One each: positions that conditioning had to move further than their quantum, one more (a count that
/// flickers) and 6 standard deviations of their noise explain (the finger went back); a band whose upper end
/// lies, at the mean speed, beyond what the grid can hold; a counter that ran over.
std::vector<TextureWarning> texture_warnings(const schema::Texture& texture);

/// Which channel was chosen where the options name none and there is no tangential_force; else empty.
std::string channel_note(const TextureOptions& options, const TouchRecord& record);

/// Where a method loses part of the band that a recording of this rate is asked for; empty where it does not.
std::string rate_warning(const TextureOptions& options, double sample_rate_hz);

}  // namespace tacto::spatial

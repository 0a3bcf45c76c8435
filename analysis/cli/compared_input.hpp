// SPDX-License-Identifier: GPL-3.0-or-later
// What a name given to `compare` stands for.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "analysis/compare/played_texture.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

struct ComparedInput {
  std::string name;  ///< for titles and messages
  std::string file;  ///< of a stored texture; else empty
  schema::Texture texture;
  std::optional<PlayedTexture> played;  ///< of a session
};

/// A texture, a recording's stroke (made into a texture as `tactograph spatial` does), or a session's.
/// `stroke` is 1-based; 0: the only one, of a session the longest. Errors: of reading and making; usage:
/// several textures, and none chosen, or no such one. `progress` hears fractions of a session's reading.
schema::Result<ComparedInput> compared_input(const std::string& name, std::size_t stroke,
                                             const std::function<void(double)>& progress = {});

/// Where exactly one of them is of a session, the other becomes what that session wanted. Errors: as
/// wanted_of; unsuitable: the other is no stored texture.
schema::Result<void> match_session(ComparedInput& a, ComparedInput& b);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an input of `compare` by its name.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "analysis/compare/played_texture.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/cli/texture_inputs.hpp"

namespace tacto::analysis {

/// Whether this is the name of a session.
bool names_a_session(const std::string& name);

struct ComparedInput {
  std::string name;  ///< for titles and messages
  std::string file;  ///< path of a stored texture, otherwise empty
  schema::Texture texture;
  std::optional<PlayedTexture> played;  ///< set for a session
};

/// Reads a texture, or makes one from a recording's stroke (as `tactograph spatial` does) or a session's
/// stroke. `stroke` is 1-based; 0 selects the only stroke, or the longest of a session. `progress` receives
/// the read fraction of a session. Errors: those of reading and of making the texture; usage: several
/// textures without a choice, or a stroke that does not exist.
schema::Result<ComparedInput> compared_input(const std::string& name, std::size_t stroke,
                                             const std::function<void(double)>& progress = {});
/// A texture that is already read.
ComparedInput compared_input(spatial::NamedTexture texture);

/// If exactly one input is a session, replaces the other by that session's target. Errors: those of
/// target_of; unsuitable: the other input is not a stored texture.
schema::Result<void> match_session(ComparedInput& a, ComparedInput& b);

}  // namespace tacto::analysis

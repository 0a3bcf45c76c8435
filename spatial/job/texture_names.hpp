// SPDX-License-Identifier: GPL-3.0-or-later
// The names of textures: from -o and a recording, and which others lie under the same name.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::spatial {

/// The stem for each recording's textures: its own without `output`; in the folder that `output` is; with its
/// name for the {} in `output`; else `output`, for one recording. Errors: usage, where several recordings
/// would get one name, or one is named twice.
schema::Result<std::vector<std::string>> texture_stems(const std::vector<std::string>& recordings,
                                                       const std::string& output);

/// Whether `output` is the name of one texture: not empty, no folder, and without {}.
bool names_one_texture(const std::string& output);

/// Files of textures STEM, STEM-NUMBER, STEM-forward and STEM-backward that are not among `made`.
std::vector<std::string> other_textures(const std::string& stem, const std::vector<std::string>& made);

}  // namespace tacto::spatial

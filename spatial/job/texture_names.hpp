// SPDX-License-Identifier: GPL-3.0-or-later
// The names of textures, from -o and a recording, and other files with the same stem.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::spatial {

/// The stem for each recording's textures. Without `output` it is the recording's own; a folder is put in
/// front of it; {} in `output` is replaced by it; otherwise the stem is `output`, for one recording. Errors:
/// usage, if several recordings would have one stem, or one is named twice.
schema::Result<std::vector<std::string>> texture_stems(const std::vector<std::string>& recordings,
                                                       const std::string& output);

/// Whether `output` is the name of one texture: not empty, not a folder, and without {}.
bool names_one_texture(const std::string& output);

/// Files of textures STEM, STEM-NUMBER, STEM-forward and STEM-backward that are not among `made`.
std::vector<std::string> other_textures(const std::string& stem, const std::vector<std::string>& made);

}  // namespace tacto::spatial

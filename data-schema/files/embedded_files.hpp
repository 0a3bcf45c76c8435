// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are in the program (tacto_embed in CMake).
#pragma once

#include <span>
#include <string_view>

namespace tacto::schema {

struct EmbeddedFile {
  std::string_view name;  ///< "recording.schema.json"
  std::string_view content;
};

/// The schemas, the presets and the glossary of this room.
std::span<const EmbeddedFile> embedded_files();

}  // namespace tacto::schema

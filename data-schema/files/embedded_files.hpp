// SPDX-License-Identifier: GPL-3.0-or-later
// The schemas, the presets and the glossary of this room, embedded in the program.
#pragma once

#include <span>
#include <string_view>

namespace tacto::schema {

struct EmbeddedFile {
  std::string_view name;  ///< "recording.schema.json"
  std::string_view text;
};

std::span<const EmbeddedFile> embedded_files();

}  // namespace tacto::schema

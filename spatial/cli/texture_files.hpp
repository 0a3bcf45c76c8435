// SPDX-License-Identifier: GPL-3.0-or-later
// The textures that a command line names.
#pragma once

#include <string>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/texture.hpp"

namespace tacto::spatial {

struct TextureFile {
  std::string path;  ///< of the sidecar
  std::string name;  ///< its stem without folders
  schema::Texture texture;
};

/// All textures that the names stand for, each once, in their order. Where several are named, files of other
/// kinds are passed over with a warning. Errors: not_found, malformed, unsupported_version; unsuitable, where
/// none is a texture, or where they hold different quantities.
schema::Result<std::vector<TextureFile>> open_textures(const std::vector<std::string>& names);

/// What a library said of a texture, with its file.
template <class T>
tl::unexpected<schema::Error> said_of(const TextureFile& file, const schema::Result<T>& failed) {
  schema::Error error = failed.error();
  if (error.fault == schema::Fault::unsuitable)
    error.where = error.where.empty() ? file.path : file.path + ": " + error.where;
  return tl::unexpected(error);
}

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/served_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <variant>

#include "data-schema/files/files.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "data-schema/volume/volume.hpp"
#include "playback/player/placed_textures.hpp"

namespace tacto::playback {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

bool stays_below(const fs::path& name) {
  return name.is_relative() && std::ranges::find(name, fs::path("..")) == name.end();
}

// All links are followed. Only a user with write access to the folder could change a name after this.
bool is_within(const fs::path& folder, const fs::path& path) {
  std::error_code failed;
  const fs::path real = fs::canonical(path, failed);
  if (failed || !fs::is_regular_file(real, failed)) return false;
  const fs::path home = fs::canonical(folder, failed);
  return !failed && std::ranges::mismatch(home, real).in1 == home.end();
}

bool serves_texture(const fs::path& folder, const std::string& name) {
  const std::string sidecar = schema::stem_of(name, ".texture") + ".texture.json";
  if (!is_within(folder, sidecar)) return false;
  const auto wav = schema::texture_wav(name);
  return !wav || is_within(folder, wav->path);  // a sidecar that cannot be read gives an error later
}

bool serves_scene(const fs::path& folder, const std::string& name) {
  const std::string path = schema::scene_path(name);
  if (!is_within(folder, path)) return false;
  const auto scene = schema::read_scene(path);
  if (!scene) return true;  // the error is that of the file
  const auto in_folder = [&](const schema::ForceLayer& layer) {
    return layer.visit(
        [&](const schema::HeightMapLayer& map) {
          return is_within(folder, schema::height_map_path(schema::texture_in_scene(path, map.file)));
        },
        [&](const schema::TextureForceLayer& texture) {
          return serves_texture(folder, schema::texture_in_scene(path, texture.file));
        },
        [&](const auto& /*names a CSV, or no file*/) {
          const std::string file = schema::file_of(layer);
          return file.empty() || is_within(folder, schema::texture_in_scene(path, file));
        });
  };
  for (const schema::Patch& patch : scene->patches)
    if (!std::ranges::all_of(patch.layers, in_folder)) return false;
  for (const schema::Piece& piece : scene->pieces) {
    if (!piece.mesh.empty() &&
        !is_within(folder, schema::mesh_path(schema::texture_in_scene(path, piece.mesh))))
      return false;
    if (piece.relief &&
        !is_within(folder, schema::height_map_path(schema::texture_in_scene(path, piece.relief->file))))
      return false;
    if (!piece.volume.empty() &&
        !is_within(folder, schema::volume_path(schema::texture_in_scene(path, piece.volume))))
      return false;
    if (!piece.texture || piece.texture->file.empty()) continue;
    const std::string file = schema::texture_in_scene(path, piece.texture->file);
    if (piece.texture->type == schema::PieceTextureType::bump
            ? !is_within(folder, schema::height_map_path(file))
            : !serves_texture(folder, file))
      return false;
  }
  return std::ranges::all_of(scene->layers, [&](const schema::Layer& layer) {
    return layer.visit([&](const schema::TextureLayer& texture) {
      return serves_texture(folder, schema::texture_in_scene(path, texture.texture));
    });
  });
}

}  // namespace

Result<std::string> served_file(const std::string& folder, const std::string& file) {
  if (folder.empty())
    return fail(ErrorKind::unsuitable, "clients over TCP may not load any file", "load",
                "name the folder that they may load from: files, in the daemon's configuration");
  const std::string path = (fs::path(folder) / file).string();
  const bool served =
      stays_below(file) && (names_a_scene(path) ? serves_scene(folder, path) : serves_texture(folder, path));
  if (served) return path;
  return fail(ErrorKind::not_found, "there is no such texture or scene in the folder for clients over TCP",
              file, "name one by its path within that folder: files, in the daemon's configuration");
}

}  // namespace tacto::playback

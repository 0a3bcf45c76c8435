// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/cli/texture_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "data-schema/cli/verb.hpp"
#include "data-schema/file_kind.hpp"
#include "data-schema/files.hpp"

namespace tacto::spatial {
namespace {

using schema::Fault;
using schema::Result;

Result<std::vector<std::string>> texture_paths(const std::string& name, bool alone) {
  const auto files = schema::stored_files(name);
  if (!files) return schema::forward_error(files);
  std::vector<std::string> paths;
  for (const auto& file : *files)
    if (file.kind == schema::FileKind::texture) paths.push_back(file.path);
  if (!paths.empty()) return paths;
  const std::string what = fmt::format("is a {}, not a texture", schema::kind_name(files->front().kind));
  if (alone)
    return schema::fail(Fault::unsuitable, what, name, "'tactograph spatial' makes textures from recordings");
  cli::warn(fmt::format("{}: {}; skipped", name, what));
  return paths;
}

Result<std::vector<std::string>> all_paths(const std::vector<std::string>& names) {
  std::vector<std::string> paths;
  for (const std::string& name : names) {
    const auto found = texture_paths(name, names.size() == 1);
    if (!found) return schema::forward_error(found);
    for (const std::string& path : *found)
      if (std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
  }
  if (paths.empty()) return schema::fail(Fault::unsuitable, "there is no texture among the files named");
  return paths;
}

Result<TextureFile> open_texture(const std::string& path) {
  auto texture = schema::read_texture(path);
  if (!texture) return schema::forward_error(texture);
  if (!texture->newer_version.empty())
    cli::warn(fmt::format("{}: is of the newer version {}; what is unknown in it is left alone", path,
                          texture->newer_version));
  const std::string name = std::filesystem::path(schema::stem_of(path, ".texture")).filename().string();
  return TextureFile{path, name, std::move(*texture)};
}

}  // namespace

Result<std::vector<TextureFile>> open_textures(const std::vector<std::string>& names) {
  const auto paths = all_paths(names);
  if (!paths) return schema::forward_error(paths);
  std::vector<TextureFile> files;
  for (const std::string& path : *paths) {
    auto file = open_texture(path);
    if (!file) return schema::forward_error(file);
    const auto& first = files.empty() ? file->texture : files.front().texture;
    if (file->texture.quantity != first.quantity || file->texture.unit != first.unit)
      return schema::fail(Fault::unsuitable,
                          fmt::format("holds {}, but {} holds {}", file->texture.quantity, files.front().path,
                                      first.quantity),
                          path, "take textures of one quantity at a time");
    files.push_back(std::move(*file));
  }
  return files;
}

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::schema {
namespace {

void check_layer(const std::string& path, std::size_t index, const TextureLayer& layer,
                 std::vector<Finding>& findings) {
  const std::string where = fmt::format("{}#/layers/{}/texture", path, index);
  const auto texture = read_texture(texture_in_scene(path, layer.texture));
  if (!texture) findings.push_back({where, message(texture.error())});
  if (texture && texture->unit != "N")
    findings.push_back(
        {where, fmt::format("{} is in {}: a scene plays forces, in N", layer.texture, texture->unit)});
}

Finding fault_of(const Error& error) {
  return {error.where, error.remedy.empty() ? error.what : error.what + "; " + error.remedy};
}

}  // namespace

std::vector<Finding> check_scene(const std::string& path, const Document& document) {
  std::vector<Finding> findings;
  const auto scene = parse_scene(document.body.dump(), path);
  if (!scene) return {fault_of(scene.error())};
  for (std::size_t i = 0; i < scene->layers.size(); ++i)
    scene->layers[i].visit([&](const TextureLayer& layer) { check_layer(path, i, layer, findings); });
  return findings;
}

}  // namespace tacto::schema

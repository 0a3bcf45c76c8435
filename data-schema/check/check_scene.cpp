// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/scene/atoms.hpp"
#include "data-schema/scene/force_grid.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/volume/volume.hpp"

namespace tacto::schema {
namespace {

void check_played_texture(const std::string& path, const std::string& name, const std::string& where,
                          std::vector<Finding>& findings) {
  const auto texture = read_texture(texture_in_scene(path, name));
  if (!texture) findings.push_back({where, message(texture.error())});
  if (texture && texture->unit != "N")
    findings.push_back(
        {where, fmt::format("{} is in {}, but a scene needs forces in N", name, texture->unit)});
}

void check_layer(const std::string& path, std::size_t index, const TextureLayer& layer,
                 std::vector<Finding>& findings) {
  check_played_texture(path, layer.texture, fmt::format("{}#/layers/{}/texture", path, index), findings);
}

// Reads the files that a layer of a patch names.
class ForceLayerFiles {
 public:
  ForceLayerFiles(const std::string& path, std::string where, std::vector<Finding>& findings)
      : path_(path), where_(std::move(where)), findings_(findings) {}

  void operator()(const HeightMapLayer& layer) {
    const auto map = read_height_map(texture_in_scene(path_, layer.file));
    if (!map) findings_.push_back({where_, message(map.error())});
  }
  void operator()(const ForceMapLayer& layer) {
    const auto grid = read_force_grid(texture_in_scene(path_, layer.file));
    if (!grid) findings_.push_back({where_, message(grid.error())});
  }
  void operator()(const TextureForceLayer& layer) {
    check_played_texture(path_, layer.file, where_, findings_);
  }
  void operator()(const FieldLayer& layer) {
    const auto atoms = read_atoms(texture_in_scene(path_, layer.file));
    if (!atoms) findings_.push_back({where_, message(atoms.error())});
  }
  template <class L>
    requires(!requires(L layer) { layer.file; })
  void operator()(const L& /*layer*/) {}

 private:
  const std::string& path_;
  std::string where_;
  std::vector<Finding>& findings_;
};

void check_patch(const std::string& path, std::size_t index, const Patch& patch,
                 std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < patch.layers.size(); ++i) {
    const std::string where = fmt::format("{}#/patches/{}/layers/{}/file", path, index, i);
    patch.layers[i].visit(ForceLayerFiles(path, where, findings));
  }
}

}  // namespace

std::vector<Finding> check_scene(const std::string& path, const Document& document) {
  std::vector<Finding> findings;
  const auto scene = parse_scene(document.body.dump(), path);
  if (!scene) return {finding_of(scene.error())};
  for (std::size_t i = 0; i < scene->layers.size(); ++i)
    scene->layers[i].visit([&](const TextureLayer& layer) { check_layer(path, i, layer, findings); });
  for (std::size_t i = 0; i < scene->patches.size(); ++i) check_patch(path, i, scene->patches[i], findings);
  for (std::size_t i = 0; i < scene->pieces.size(); ++i) {
    const auto& texture = scene->pieces[i].texture;
    if (texture && texture->type == PieceTextureType::bump) {
      const auto map = read_height_map(texture_in_scene(path, texture->file));
      if (!map)
        findings.push_back({fmt::format("{}#/pieces/{}/texture/file", path, i), message(map.error())});
    } else if (texture && texture->type == PieceTextureType::recording)
      check_played_texture(path, texture->file, fmt::format("{}#/pieces/{}/texture/file", path, i), findings);
    if (const auto& relief = scene->pieces[i].relief) {
      const auto map = read_height_map(texture_in_scene(path, relief->file));
      if (!map) findings.push_back({fmt::format("{}#/pieces/{}/relief/file", path, i), message(map.error())});
    }
    if (scene->pieces[i].shape == PieceShape::volume) {
      const auto volume = read_volume(texture_in_scene(path, scene->pieces[i].volume));
      if (!volume)
        findings.push_back({fmt::format("{}#/pieces/{}/volume", path, i), message(volume.error())});
    }
    if (scene->pieces[i].shape != PieceShape::mesh) continue;
    const auto mesh = read_mesh(texture_in_scene(path, scene->pieces[i].mesh));
    if (!mesh) findings.push_back({fmt::format("{}#/pieces/{}/mesh", path, i), message(mesh.error())});
  }
  return findings;
}

}  // namespace tacto::schema

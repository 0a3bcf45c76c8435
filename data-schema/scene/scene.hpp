// SPDX-License-Identifier: GPL-3.0-or-later
// A scene: what is under the finger, and where, as NAME.scene.json.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/one_of.hpp"
#include "data-schema/scene/patch.hpp"
#include "data-schema/scene/piece.hpp"
#include "data-schema/scene/playback_choices.hpp"

namespace tacto::schema {

/// What follows beyond a texture's ends.
enum class TextureEnds { stop, mirror, loop };

/// A recorded texture on the finger's path.
struct TextureLayer {
  std::string texture;      ///< as in the scene: stem or file name
  double at_m = 0;          ///< place of its position 0 on the path
  double gain_m_per_n = 0;  ///< G_psi: displacement for force
  std::string gain_set_by, gain_set_on;
  TextureEnds ends = TextureEnds::stop;  ///< stop, unless it is the only layer
  std::string extra_json;                ///< members of a newer version
};

/// One layer of a scene for a tray, of one kind. Code that reads a layer handles every kind of it, or does
/// not compile.
using Layer = OneOf<TextureLayer>;

/// Layers of a scene, in all. The kernel has the same limit (core::kMostSceneLayers).
inline constexpr std::size_t kMostLayers = 256;

struct Scene {
  std::vector<Layer> layers;       ///< of a tray; their target displacements add up
  std::vector<Patch> patches;      ///< of a force device; a scene has layers, patches, or both
  std::vector<Piece> pieces = {};  ///< in space, of a force device; not beside patches
  double point_radius_m = 0;       ///< of the sphere that touches the pieces; radius_m in the file
  PieceContact contact = PieceContact::ghost;
  std::string name, notes;
  std::string created, creator;
  PlaybackChoices playback;
  std::string extra_json;
  std::string newer_version;  ///< with which it is written again
  std::vector<std::string> unknown_members = {};
  std::vector<std::array<double, 3>> tool_m =
      {};  ///< points that touch volumes, from the hand; empty: the hand
};

/// "stop", "mirror", "loop".
std::string_view to_string(TextureEnds ends);

/// By stem or NAME.scene.json. Errors: not_found; malformed, by JSON pointer, also for an unknown member (in
/// a newer minor version it is kept); unsuitable, by JSON pointer, for an unknown type of layer (naming the
/// known ones), for one of several textures that continues beyond its ends, and by check_patches;
/// unsupported_version.
Result<Scene> read_scene(const std::string& name);

/// The same from a text; `where` names it in errors.
Result<Scene> parse_scene(std::string_view text, const std::string& where);

/// The text of its file; `where` names it in errors. Errors: unsuitable, if the schema does not allow it, and
/// by check_patches.
Result<std::string> scene_json(const Scene& scene, const std::string& where);

/// Replaces an existing file. Errors: cannot_write, also for a read-only file; unsuitable, if the schema does
/// not allow it, and by check_patches.
Result<void> write_scene(const std::string& stem, const Scene& scene);

/// Checks what the schema cannot: the number of layers, different names of patches, values within their
/// sliders, masses of bodies, friction. Errors: unsuitable, by JSON pointer.
Result<void> check_patches(const Scene& scene, const std::string& where);

/// The same of pieces: different names, members of their shapes, quadrics that are neither empty nor the
/// whole space. Errors: unsuitable, by JSON pointer.
Result<void> check_pieces(const Scene& scene, const std::string& where);

/// For commands that play patches in a plane. Errors: unsuitable, if the scene has pieces.
Result<void> check_only_plane(const Scene& scene, const std::string& where);

/// For commands that play a tray. Errors: unsuitable, if the scene has force patches or pieces.
Result<void> check_only_tray(const Scene& scene, const std::string& where);

/// NAME.scene.json of a stem or file name.
std::string scene_path(const std::string& name);

/// A layer's texture as it can be opened from here: relative names start from the scene's folder.
std::string texture_in_scene(const std::string& scene_path, const std::string& texture);

}  // namespace tacto::schema

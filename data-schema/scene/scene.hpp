// SPDX-License-Identifier: GPL-3.0-or-later
// A scene: the textures under the finger and their places, as NAME.scene.json.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/one_of.hpp"
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

/// One layer of a scene, of one kind. Code that reads a layer handles every kind of it, or does not compile:
/// height maps, walls, friction and contact transients become further kinds.
using Layer = OneOf<TextureLayer>;

struct Scene {
  std::vector<Layer> layers;  ///< at least one; their target displacements add up
  std::string name, notes;
  std::string created, creator;
  PlaybackChoices playback;
  std::string extra_json;
  std::string newer_version;  ///< with which it is written again
};

/// "stop", "mirror", "loop".
std::string_view to_string(TextureEnds ends);

/// By stem or NAME.scene.json. Errors: not_found; malformed, by JSON pointer, also for an unknown member (in
/// a newer minor version it is kept); unsuitable, by JSON pointer, for an unknown type of layer (naming the
/// known ones), and for one of several textures that continues beyond its ends; unsupported_version.
Result<Scene> read_scene(const std::string& name);

/// The same from a text; `where` names it in errors.
Result<Scene> parse_scene(std::string_view text, const std::string& where);

/// Replaces an existing file. Errors: cannot_write, also for a read-only file; unsuitable, if the schema does
/// not allow it.
Result<void> write_scene(const std::string& stem, const Scene& scene);

/// NAME.scene.json of a stem or file name.
std::string scene_path(const std::string& name);

/// A layer's texture as it can be opened from here: relative names start from the scene's folder.
std::string texture_in_scene(const std::string& scene_path, const std::string& texture);

}  // namespace tacto::schema

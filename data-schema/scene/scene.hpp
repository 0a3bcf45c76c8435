// SPDX-License-Identifier: GPL-3.0-or-later
// A scene: what lies under the finger where, as NAME.scene.json.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/one_of.hpp"
#include "data-schema/scene/playback_choices.hpp"

namespace tacto::schema {

/// What lies beyond a texture's ends.
enum class TextureEnds { stop, mirror, loop };

/// A recorded texture on the finger's path.
struct TextureLayer {
  std::string texture;      ///< as the scene says it: stem or file name
  double at_m = 0;          ///< where its position 0 lies on the path
  double gain_m_per_n = 0;  ///< G_psi: displacement for force
  std::string gain_set_by, gain_set_on;
  TextureEnds ends = TextureEnds::stop;  ///< stop, unless it is the only layer
  std::string extra_json;                ///< members of a newer version
};

/// One layer of a scene, of one kind. Code that reads a layer handles every kind of it, or does not compile:
/// height maps, walls, friction and contact transients become further kinds.
using Layer = OneOf<TextureLayer>;

struct Scene {
  std::vector<Layer> layers;  ///< at least one; their wanted displacements add up
  std::string name, notes;
  std::string created, creator;
  PlaybackChoices playback;
  std::string extra_json;
  std::string newer_version;  ///< with which it is written again
};

/// "stop", "mirror", "loop".
std::string_view to_string(TextureEnds ends);

/// By stem or NAME.scene.json. Errors: not_found; malformed, by JSON pointer, also a member that is not known
/// here (of a newer minor version it is kept); unsuitable, by JSON pointer,
/// for a type of layer that this program does not know (with those that it does), and for one of several
/// textures that would go on beyond its ends; unsupported_version.
Result<Scene> read_scene(const std::string& name);

/// The same from a text; `where` names it in errors.
Result<Scene> parse_scene(std::string_view text, const std::string& where);

/// Replaces what is there. Errors: cannot_write, also of a file that is read-only; unsuitable, where the
/// schema does not allow it.
Result<void> write_scene(const std::string& stem, const Scene& scene);

/// NAME.scene.json of a stem or file name.
std::string scene_path(const std::string& name);

/// A layer's texture as it can be opened from here: relative names start from the scene's folder.
std::string texture_in_scene(const std::string& scene_path, const std::string& texture);

}  // namespace tacto::schema

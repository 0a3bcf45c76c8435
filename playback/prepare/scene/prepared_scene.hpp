// SPDX-License-Identifier: GPL-3.0-or-later
// From the force patches of a scene to the block that the kernel of a device reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/scene/atoms.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/volume/volume.hpp"
#include "firmware-host/core/scene/scene_block.hpp"
#include "playback/prepare/relief/relief_levels.hpp"

namespace tacto::playback {

/// Displacement of one encoder count, of the axes x and y; of an axis that the device does not have that of
/// the other one, of z that of x, as in core::SceneKernel; and the period of a tick.
struct PlaneSteps {
  double x_m = 1, y_m = 1;
  double tick_s = 1;
  double z_m = 1;
};

PlaneSteps steps_of(const schema::Device& device, double rate_hz);

/// A hand that is faster is a jump of the encoder.
inline constexpr double kFastestHandMps = 10;

/// The height maps, textures, atoms, force maps and volumes of a scene, by the names in their layers.
struct Reliefs {
  std::map<std::string, std::shared_ptr<const Relief>> height_maps, textures;
  /// Of planes, by PieceRelief::surface: surface_relief() or clay_relief().
  std::map<std::string, std::shared_ptr<const Relief>> surfaces = {};
  std::map<std::string, std::shared_ptr<const ForceRelief>> force_maps;
  std::map<std::string, std::shared_ptr<const std::vector<schema::Atom>>> atoms;
  std::map<std::string, std::shared_ptr<const schema::Volume>> volumes = {};  ///< by Piece::volume

  const Relief& of(const schema::PieceTexture& texture) const {
    const bool recording = texture.type == schema::PieceTextureType::recording;
    return *(recording ? textures : height_maps).at(texture.file);
  }
  const Relief& of(const schema::PieceRelief& relief) const { return *surfaces.at(relief.surface); }
  const Relief& of(const schema::HeightMapLayer& layer) const { return *height_maps.at(layer.file); }
  const Relief& of(const schema::TextureForceLayer& layer) const { return *textures.at(layer.file); }
  const ForceRelief& of(const schema::ForceMapLayer& layer) const { return *force_maps.at(layer.file); }
  const std::vector<schema::Atom>& of(const schema::FieldLayer& layer) const { return *atoms.at(layer.file); }
};

/// The block for one device, and the patches from which it was made, both from the topmost patch on.
struct PreparedScene {
  std::vector<schema::Patch> patches;  ///< filter_m of grooves is a number; with the dampers that were added
  std::vector<std::uint32_t> words;    ///< the block (core::SceneHeader), little-endian
  PlaneSteps steps;
  double stiffness_limit_n_per_m = 0;  ///< stiffness_limit_of()
  Reliefs reliefs = {};
  /// In place of patches, in the order of the block.
  std::vector<schema::Piece> pieces = {};
  std::map<std::string, std::shared_ptr<const schema::Mesh>> meshes = {};  ///< by Piece::mesh
  double point_radius_m = 0;
  schema::PieceContact contact = schema::PieceContact::ghost;
  std::vector<std::array<double, 3>> tool_m = {};  ///< schema::Scene::tool_m

  std::size_t bytes() const { return words.size() * sizeof(std::uint32_t); }
  /// What the device needs to have free for it: the block, and tables that the hand changes once more.
  std::size_t room_bytes() const {
    const core::SceneView of = view();
    return bytes() + (of.tables_change ? of.table_words * sizeof(std::uint32_t) : 0);
  }
  /// Points into this object.
  core::SceneView view() const;
  /// Other patches for the same device, each of them once part of such a scene.
  PreparedScene with(std::vector<schema::Patch> others) const;
  /// What makes a scene with height maps, force maps, textures, meshes or volumes small enough for this many
  /// bytes, in words; empty if nothing does.
  std::string remedy_for(std::size_t room) const;
  /// The bytes of a layer in the block.
  std::size_t layer_bytes(const schema::Patch& patch, const schema::ForceLayer& layer) const;
};

/// The table of a map (core::ReliefTable); its columns grow along `angle_deg` from the patch's axis x.
std::vector<std::uint32_t> relief_table(const Relief& relief, double angle_deg, const schema::Patch& patch,
                                        const PlaneSteps& steps);

/// The members of a layer that are numbers in the block, in its order: they can change while the scene plays
/// (core::SceneKernel::change).
std::vector<std::string_view> numbers_in_block(const schema::ForceLayer& layer);

/// The largest stiffness that is stable at this rate along both axes, with this damper of the scene: of the
/// free device, or of the device with the mass, damping and stiffness of a hand. Coulomb friction is left
/// out. Along z, too, for pieces in space.
double stiffness_limit_of(const schema::Device& device, double rate_hz,
                          const std::optional<schema::Hand>& hand, double virtual_damping_n_s_per_m = 0,
                          bool in_space = false);

/// Sets the filters that the file leaves to the program (filter_m: auto) for that limit. `where` is the
/// scene's file. Errors: unsuitable: the limit is 0, by JSON pointer.
schema::Result<void> set_filters(schema::Scene& scene, double limit_n_per_m, const std::string& where);

/// Reads the height maps, textures, atoms, force maps and volumes of all layers and pieces, and sets their
/// curvature, steepest_n_per_m, stiffest_n_per_m, slopes and steepness. Textures fade at their ends as on a
/// tray (TextureLookup); those of pieces are less their mean, with the sign of a stroke that goes forth; a
/// relief with interpolated normals becomes a texture of the type normals. `where` is the scene's file.
/// Errors: as read_height_map, relief_levels, read_texture, check_playable, read_atoms, check_section,
/// read_force_grid, force_levels, read_piece_volume, clay_relief; unsuitable: a texture whose mean force is
/// too large for its length.
schema::Result<Reliefs> read_reliefs(schema::Scene& scene, const std::string& where, double rate_hz);

/// Of a patch along a direction in it: the length of its shadow.
double length_across(const schema::Patch& patch, double direction_deg);

/// Builds what the scene names and nothing else; of pieces by prepare_pieces(). Equal orders: the later patch
/// is above. `where` is the scene's file. Preconditions: a scene as read_scene() gives it; the device has
/// this rate, and an axis x or y. Errors: unsuitable, if it has neither patches nor pieces; by JSON pointer,
/// for bodies (check_bodies()), and for the filter of grooves on a device without viscous friction; as
/// read_reliefs and add_adaptive_damping.
schema::Result<PreparedScene> prepare_scene(schema::Scene scene, const std::string& where,
                                            const schema::Device& device, double rate_hz,
                                            const std::optional<schema::Hand>& hand = std::nullopt);

}  // namespace tacto::playback

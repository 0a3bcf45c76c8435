// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces in space and their ghost point in double precision: the reference for the kernel's.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/volume/volume.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/render/reference/exact_mesh.hpp"

namespace tacto::playback {

using SpaceMetres = std::array<double, 3>;

/// The contract of core::GhostPoint, core::wall_force, core::texture_force and core::friction_force, by other
/// methods: the planes
/// that hold the ghost by Hildreth's iteration over all that it touches, the entry into a piece by samples
/// and bisection, curved surfaces by many small steps instead of a closed form, meshes by trying all
/// triangles, each slip of the friction by bisection, volumes by the weights of
/// their values. Slow; not for the tick.
class ExactGhost {
 public:
  /// Keeps references to both.
  ExactGhost(const PreparedScene& scene, const schema::Device& device, double rate_hz);

  /// One tick: the force on a hand at this place, m, with this speed, m/s.
  SpaceMetres force(const SpaceMetres& hand_m, const SpaceMetres& speed_mps);
  const SpaceMetres& ghost_m() const { return ghost_m_; }

 private:
  struct Wall {
    double integral_n = 0, impulse_ns = 0;
    bool touched = false;
    double contact_mps = 0;  // inwards
    int ticks = 0;           // since the first one of the contact
    SpaceMetres anchor_m = {}, last_m = {};
    SpaceMetres line = {};
    double path_m = 0;
    double slid_m = 0, slid_mps = 0;
  };
  struct Surface {
    double distance_m = 0;
    SpaceMetres normal = {};
  };
  struct Held {
    SpaceMetres normal = {};
    double depth_m = 0;
  };
  // A plane that holds the ghost or may do so.
  struct Touch {
    std::size_t piece = 0;
    Surface surface;  // of a triangle it is a skin above it
    double skin_m = 0, push_m = 0;
  };
  struct TouchedTriangle {
    std::size_t piece = 0, triangle = 0;
  };
  struct CarvedVolume {
    schema::Volume volume;
    std::int16_t lowest = 0;
    double uncut = 0;  // the part of a step that a tick left
  };
  void add_triangles(std::vector<Touch>& touches);
  Surface surface_at(const schema::Piece& piece, const SpaceMetres& place_m) const;
  double entry_of(const schema::Piece& piece, const SpaceMetres& from_m, const SpaceMetres& way_m) const;
  std::vector<Held> follow(const SpaceMetres& hand_m);
  Held shortest_way_out(const schema::Piece& piece, const SpaceMetres& hand_m) const;
  Held nearest_face(const schema::Piece& piece, const SpaceMetres& hand_m) const;
  double transient_n(const schema::Piece& piece, const Wall& wall) const;
  double wall_force(const schema::Piece& piece, Wall& wall, const Held& held, double outside_m,
                    double speed_mps) const;
  SpaceMetres friction_force(const schema::Piece& piece, Wall& wall, double normal_n,
                             const SpaceMetres& normal, const SpaceMetres& place_m,
                             const SpaceMetres& speed_mps) const;

  SpaceMetres texture_force(const schema::Piece& piece, Wall& wall, double& normal_n,
                            const SpaceMetres& normal, const SpaceMetres& place_m,
                            const SpaceMetres& speed_mps) const;

  SpaceMetres offset_of(std::size_t piece) const;
  void move_slide(std::size_t piece, double push_n);

  Held in_volume(std::size_t piece, const SpaceMetres& hand_m, double& outside_m);
  double fall_of_tick(std::size_t piece);
  void carve(std::size_t piece, const SpaceMetres& place_m, double fall);
  const Relief& relief_of(const schema::Piece& piece) const;
  void press_clay(const schema::Piece& piece, const SpaceMetres& place_m);

  const PreparedScene& scene_;
  const schema::Device& device_;
  double tick_s_;
  bool placed_ = false;
  SpaceMetres ghost_m_ = {};
  std::vector<Wall> walls_;
  std::vector<schema::Piece> pieces_;                // where they are now
  std::vector<std::optional<ExactMesh>> meshes_;     // of each piece
  std::vector<std::optional<CarvedVolume>> carved_;  // of each piece that can be carved
  std::map<std::string, Relief> clay_;               // by the names of pieces, as it is now
  std::vector<TouchedTriangle> triangles_;           // that the ghost met and is still near
};

}  // namespace tacto::playback

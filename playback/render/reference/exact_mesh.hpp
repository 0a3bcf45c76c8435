// SPDX-License-Identifier: GPL-3.0-or-later
// A point near a triangle mesh in double precision, by trying all triangles: the reference for the kernel's
// tree.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "data-schema/mesh/mesh.hpp"

namespace tacto::playback {

/// Distance that the ghost keeps from a mesh: in double precision far more than what places round by.
inline constexpr double kExactSkin_m = 1e-9;

/// The contract of core::first_hit and core::side_of. Places are in the coordinates of the scene.
class ExactMesh {
 public:
  using Place = std::array<double, 3>;

  ExactMesh(std::shared_ptr<const schema::Mesh> mesh, const Place& origin_m);

  struct Side {
    Place normal = {};
    double above_m = 0, distance_m = 0;
    Place away = {};      ///< unit vector from the nearest place of the triangle
    bool beside = false;  ///< the nearest place is on an edge
  };
  double distance_m(const Place& place_m) const;
  Side side_of(std::size_t triangle, const Place& place_m) const;

  struct Hit {
    double part = 2;
    std::size_t triangle = 0;
  };
  /// Where a point that comes from outside is half a skin away from a triangle for the first time; it stops a
  /// skin away.
  std::optional<Hit> first_hit(const Place& from_m, const Place& way_m) const;

 private:
  std::shared_ptr<const schema::Mesh> mesh_;
  Place origin_m_;
};

}  // namespace tacto::playback

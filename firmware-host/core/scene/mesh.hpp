// SPDX-License-Identifier: Apache-2.0
// A point near a triangle mesh: the triangle that it meets first on a straight way, and its place beside a
// triangle (Zilles and Salisbury 1995; Ruspini, Kolarov and Khatib 1997).
#pragma once

#include "firmware-host/core/scene/piece.hpp"

namespace tacto::core {

/// A place beside a triangle. Of a triangle without an area (in single precision) the normal is 0.
struct TriangleSide {
  SpaceVector normal;    ///< outwards
  float above_m = 0;     ///< over its plane, negative on the inner side
  float distance_m = 0;  ///< from the triangle itself, its edges and corners included
  SpaceVector away;      ///< unit vector from the nearest place of the triangle
  bool beside = false;   ///< the nearest place is on an edge
};

/// `place` is from the origin of the piece, as below. Precondition: the mesh has this triangle. Safe in the
/// tick.
TriangleSide side_of(const MeshTable& table, uint32_t triangle, SpaceVector place) noexcept;

inline constexpr uint32_t kNoTriangle = 0xFFFFFFFF;

struct MeshHit {
  float part = 2;  ///< of the way, up to 1, after which it stops; above 1: it does not stop
  uint32_t triangle = kNoTriangle;
};

/// Where a point that comes from outside is half a skin away from a triangle for the first time. The point is
/// a ball of that radius: it meets edges and corners, so that it slips through between no two triangles, and
/// half a skin is many times what a place rounds by. The distance from a triangle is a convex function along
/// a line; Newton's method comes to its first place from the left and never passes it. A triangle is met from
/// its outer side only. Of several at the same place it is the one that the way enters most steeply. The way
/// ends before, a whole skin away, if it begins there. A way from far away ends near the mesh, without a
/// triangle, where the places are exact. Safe in the tick: at most one step per node, kMostSteps of Newton's
/// method per triangle in the boxes that the way crosses.
MeshHit first_hit(const MeshTable& table, SpaceVector place, SpaceVector way) noexcept;

/// Whether a triangle is within `reach_m` of the place. Safe in the tick.
bool is_near(const MeshTable& table, SpaceVector place, float reach_m) noexcept;

/// Whether a point there is held by a triangle that it met: over it, within one and a half skins; beside it,
/// within one and an eighth, and on its outer side.
inline bool is_held_by(const MeshTable& table, const TriangleSide& side) noexcept {
  constexpr float kBehind = -0.05F;  // sine of the angle below the plane, beside an edge
  return side.distance_m <= (side.beside ? 1.125F : 1.5F) * table.skin_m &&
         side.above_m >= kBehind * side.distance_m && dot(side.normal, side.normal) > 0;
}

}  // namespace tacto::core

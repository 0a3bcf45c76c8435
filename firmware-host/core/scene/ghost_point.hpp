// SPDX-License-Identifier: Apache-2.0
// The ghost point: a point without a mass that stays outside of all pieces and is as near to the hand as they
// let it (Zilles and Salisbury 1995; Ruspini, Kolarov and Khatib 1997).
#pragma once

#include "firmware-host/core/scene/force_limiter.hpp"
#include "firmware-host/core/scene/mesh.hpp"
#include "firmware-host/core/scene/piece.hpp"

namespace tacto::core {

inline constexpr int kGhostPasses = 12;           ///< moves of a tick, at most
inline constexpr int kMostSlides = 4;             ///< of them along a relief (slid_on_relief())
inline constexpr uint32_t kMostTouched = 6;       ///< pieces that hold the ghost or may hold it: the nearest
inline constexpr uint32_t kMostHolding = 3;       ///< planes that hold it
inline constexpr float kFarthestInSpace_m = 100;  ///< beyond, a hand touches nothing

/// A hand in space at one tick. A missing axis stays at 0.
struct SpaceHand {
  int32_t counts[3] = {};
  SpaceVector speed_mps;
};

/// A pass: the planes of the pieces that the ghost touches, at most kMostTouched of them, leave a room; the
/// goal is its place nearest to the hand, held by kMostHolding of the planes at most (the first of their sets
/// that fits). The ghost moves there in a straight line, and stops where it would enter another piece. On one
/// curved piece it goes to the place of the surface nearest to the hand at once (nearest_on()), if that is
/// less than about 37 degrees of the normal away and nothing is between. So it passes through no surface:
/// what it touches it leaves outwards only, and what it does not touch is met in closed form. Rounding leaves
/// it at most 1e-6 m inside of a piece; there it is moved out. On a quadric that bends towards the ghost a
/// step is shorter, by the curvature, so that the passes come to an end there, too. The last passes
/// of a tick lead only out. Where they end deeper all the same, it stays at the last place outside, and goes
/// on in the next tick. The force is the sum over the holding planes of wall_force() along the normal, the
/// depth of each its share of the way from hand to ghost (the multiplier of its plane): of equal stiffness K
/// together K (ghost - hand) once the ghost has come to rest; while it is on its way, the planes where it is
/// give the force. Of a mesh each triangle is a piece of its own: one that the ghost met holds it as long as
/// it is within one and a half skins (first_hit()); the force is that of a ghost without a skin, along the
/// sum of the pushes of all its triangles. A hand that begins in a mesh touches nothing until it has left it.
/// A volume does not hold the ghost: its force is that of its potential at the hand (touch_volume()). Clay
/// sinks at the ghost (press_clay()), after its force, so the next tick is the first one on the new surface.
/// Along each piece that holds it come texture_force() and friction_force(). Their sum of a piece that slides
/// pushes it (push_slide()); where it passes the ghost it takes it along at the end of the tick, and it stops
/// where another piece holds the ghost. `contact: add`: each piece by
/// itself, from its nearest face.
class GhostPoint {
 public:
  /// Without a place: the next hand is the ghost.
  void rest() noexcept { placed_ = false, touched_.count = 0; }
  /// Force of the pieces of `scene` (SceneView::in_space) on the hand. `live`: its numbers. Safe in the tick:
  /// at most kGhostPasses times one step per piece.
  SpaceVector force(const SceneView& scene, float* live, const SpaceHand& hand, const float (&step_m)[3],
                    const ForceSetup& setup) noexcept;
  const SpacePlace& place() const noexcept { return ghost_; }

  /// Triangles of meshes that the ghost met and is still near.
  struct TouchedTriangles {
    uint32_t count = 0;
    uint32_t piece[kMostTouched] = {}, triangle[kMostTouched] = {};
  };
  /// Surfaces that hold the ghost.
  struct Holding {
    uint32_t count = 0;
    uint32_t piece[kMostHolding] = {};
    SpaceVector normal[kMostHolding];
    float depth_m[kMostHolding] = {};
  };

 private:
  Holding follow(const SceneView& scene, const SpacePlace& hand, const float (&step_m)[3]) noexcept;
  bool settle_on(const SceneView& scene, const SpacePlace& hand, const float (&step_m)[3], uint32_t touched,
                 Holding& holding) noexcept;
  float free_part(const SceneView& scene, uint32_t moved, SpaceVector way,
                  const float (&step_m)[3]) const noexcept;
  void move_slides(const SceneView& scene, float* live, bool follows, const float (&step_m)[3],
                   float tick_s) noexcept;
  static SpaceVector push_of(const Holding& holding, uint32_t piece) noexcept;
  void move(SpaceVector way, const float (&step_m)[3]) noexcept;

  SpacePlace ghost_;
  TouchedTriangles touched_;
  bool placed_ = false;
  int slides_ = 0;  // of this tick; not in the frame of follow(), which has to fit a board
};

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// Solids in space: planes, plates, spheres, cylinders and quadrics, and the law of their walls.
#pragma once

#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

struct SpaceVector {
  float x = 0, y = 0, z = 0;
};

constexpr SpaceVector operator+(SpaceVector a, SpaceVector b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr SpaceVector operator-(SpaceVector a, SpaceVector b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr SpaceVector operator*(float by, SpaceVector a) noexcept {
  return {by * a.x, by * a.y, by * a.z};
}
constexpr float dot(SpaceVector a, SpaceVector b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float length(SpaceVector a) noexcept {
  return __builtin_sqrtf(dot(a, a));
}

/// A place in space: whole counts of the axes x, y and z, and the rest. So the difference of two places is as
/// exact far from the origin as near it.
struct SpacePlace {
  int32_t counts[3] = {};
  SpaceVector rest_m;
};

/// a - b. Beyond 2^31 counts it wraps. Safe in the tick.
inline SpaceVector difference(const SpacePlace& a, const SpacePlace& b, const float (&step_m)[3]) noexcept {
  float of_counts[3];
  for (int i = 0; i < 3; ++i)
    of_counts[i] = step_m[i] * static_cast<float>(static_cast<int32_t>(static_cast<uint32_t>(a.counts[i]) -
                                                                       static_cast<uint32_t>(b.counts[i])));
  return SpaceVector{of_counts[0], of_counts[1], of_counts[2]} + (a.rest_m - b.rest_m);
}

/// A surface near a place: the distance from it, negative in the solid, and the normal out of the solid. Of a
/// quadric the distance is q / |grad q|: exact on the surface, and beside it to the second order of the
/// distance.
struct PieceSurface {
  float distance_m = 0;
  SpaceVector normal;  ///< 0 where a quadric has no gradient: at the tip of a cone, in a centre
};

/// Here and below `place` is from the origin of the piece. A mesh and a volume are far away and are not
/// entered: mesh.hpp and volume.hpp have them. Safe in the tick.
PieceSurface surface_at(SceneLayerKind kind, const PieceTable& table, SpaceVector place) noexcept;

/// The part of the way, up to 1, after which a point outside enters the solid on the straight line along
/// `way`; above 1: it does not. 0 for a point inside. Safe in the tick.
float entry_of(SceneLayerKind kind, const PieceTable& table, SpaceVector place, SpaceVector way) noexcept;

/// Of a point on a quadric that leaves the surface along `way`: the part after which it meets the surface
/// again; above 1 if it does not, if it does not leave, or if it stays within `height_m` of the surface. Safe
/// in the tick.
float return_to(const PieceTable& quadric, SpaceVector place, SpaceVector way, float height_m) noexcept;

/// The curvature of a quadric along `way` times the square of the way, where it bends towards a point
/// outside; else 0. Safe in the tick.
float bend_of(const PieceTable& quadric, SpaceVector place, SpaceVector way) noexcept;

/// Steps of Newton's method for the place of a quadric that is nearest to a hand.
inline constexpr int kQuadricSteps = 8;

/// The place of the surface that is nearest to the hand, in the neighbourhood of `start`: in closed form, and
/// of a quadric by kQuadricSteps steps of Newton's method for p + lambda grad q(p) = hand, q(p) = 0. False if
/// they did not lead to a place on the surface; of a relief, too (slid_on_relief()). Safe in the tick.
bool nearest_on(SceneLayerKind kind, const PieceTable& table, SpaceVector hand, SpaceVector start,
                SpaceVector& nearest) noexcept;

/// The place of a quadric's surface that is nearest to a hand in the solid, of all. False if no way leads
/// out. Safe in the tick.
bool nearest_face(const PieceTable& quadric, SpaceVector hand, SpaceVector& nearest) noexcept;

/// Behind the numbers of a piece, 0 in a block.
struct WallState {
  float integral_n = 0;
  float impulse_ns = 0;                  ///< of the arrest, that is left
  float touched = 0;                     ///< 1 from the first tick of a contact on
  float transient_n = 0, turning_n = 0;  ///< s and c of the transient (TransientTable)
  SpaceVector anchor_m, last_m;          ///< of the friction, and the place of the last tick
  SpaceVector line;                      ///< of the path, a unit vector; 0 before the first way
  uint32_t path = 0;                     ///< along a recorded texture: 2^32 is once forth and back
  float slid_m = 0, slid_mps = 0;        ///< of a piece with a SlideTable
};
static_assert(sizeof(WallState) == kWallStateWords * sizeof(float));

/// A hand that is this far outside has let go: a wall's integral, arrest and transient begin anew. Nearer
/// than this a hand that rests on a wall by its integral would meet a new wall at each count.
inline constexpr float kLetGo_m = 1e-4F;

struct WallTouch {
  float depth_m = 0;       ///< along the normal, 0 or below: no contact
  float outside_m = 0;     ///< of the hand outside, if there is no contact
  float speed_mps = 0;     ///< of the hand along the normal, outwards
  float most_force_n = 0;  ///< of the device along the normal
  float grain_m = 0;       ///< of a count of the encoders along the normal
  float tick_s = 0;
};

/// In counts: up to this depth the integral does not grow. The place is known to half a count; without this a
/// hand that rests on the surface would be pushed out of it.
inline constexpr float kIntegralRest = 1.5F;

/// A transient whose s and c are smaller has ended.
inline constexpr float kTransientEnd_n = 1e-9F;

/// The force of a wall's spring: stiffness x depth, or that of its TravelTable, with the point behind a jump
/// from its depth on. Safe in the tick.
float spring_force(const PieceTable& table, float stiffness, float depth_m) noexcept;

/// One tick of a wall, outwards and never below 0: spring_force() - B speed + integral + transient, and the
/// impulse m v at the beginning of a contact, of which each tick gives what the device's peak force leaves,
/// until it is spent or the hand stops. The integral grows by its number x depth x tick beyond kIntegralRest,
/// up to its bound, and leaks. The transient starts once a contact, scaled by the speed inwards of its first
/// tick, goes on while the hand is up to kLetGo_m outside, and fades by its own decay, so that its end is no
/// step. Against the closed form: within 1e-5 of its peak for decays of 20 /s and more at 1 kHz. Safe in the
/// tick.
float wall_force(const float* number, const PieceTable& table, WallState& state,
                 const WallTouch& touch) noexcept;

/// Slips of one tick that are found one by one; what is left of a longer way is taken along the last line.
inline constexpr int kMostSlips = 4;

/// One tick of friction along a surface, on a hand whose place on it is `place_m`: a spring of the piece's
/// stiffness from an anchor on the surface. Where its force reaches the static friction x `normal_n`, the
/// anchor slips until it is the kinetic one; the place of the slip is found on the straight way of the tick,
/// also of several slips. An anchor that holds stays to the bit, so that nothing drifts (Hayward and
/// Armstrong 2000). The force of the spring is never larger than the static friction, within 1e-6; the
/// viscous part, against `speed_mps` along the surface, comes on top of it. Without a force along the normal
/// the anchor is at the place. Safe in the tick.
SpaceVector friction_force(const float* number, WallState& state, float normal_n, SpaceVector normal,
                           SpaceVector place_m, SpaceVector speed_mps) noexcept;

}  // namespace tacto::core

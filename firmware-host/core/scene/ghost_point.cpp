// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/ghost_point.hpp"

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/scene/clay.hpp"
#include "firmware-host/core/scene/piece_relief.hpp"
#include "firmware-host/core/scene/piece_slide.hpp"
#include "firmware-host/core/scene/piece_texture.hpp"
#include "firmware-host/core/scene/volume.hpp"

namespace tacto::core {
namespace {

constexpr float kTouch_m = 1e-7F;     // nearer, a piece is touched
constexpr float kInside_m = 1e-6F;    // deeper is not rounding
constexpr float kSettled_m = 1e-9F;   // a shorter way is none
constexpr float kRounding_m = 2e-8F;  // of a plane's place: 24 bits of 0.3 m
constexpr float kSameSide = 0.8F;     // cosine of the largest turn of the normal in one step
constexpr float kSameAway = 0.97F;    // cosine: ways from one edge differ by rounding
constexpr float kLeaves_m = 1e-6F;    // over a surface, beyond what rounding is
constexpr float kInRelief_m = 5e-7F;  // of a step along a relief
constexpr int kPassesOut = 3;     // at the end of a tick: Newton's steps out of a surface, no way along it
constexpr float kDeepest = 0.1F;  // of a step along a surface that bends towards it

SceneLayerKind kind_of(const SceneView& scene, uint32_t piece) noexcept {
  return static_cast<SceneLayerKind>(scene.layers[piece].kind);
}

const PieceTable& piece_of(const SceneView& scene, uint32_t piece) noexcept {
  return table_of<PieceTable>(scene, scene.layers[piece]);
}

bool is_mesh(const SceneView& scene, uint32_t piece) noexcept {
  return kind_of(scene, piece) == SceneLayerKind::mesh;
}

const MeshTable& mesh_of(const SceneView& scene, uint32_t piece) noexcept {
  return table_of<MeshTable>(scene, scene.layers[piece]);
}

bool is_volume(const SceneView& scene, uint32_t piece) noexcept {
  return kind_of(scene, piece) == SceneLayerKind::volume;
}

const WallState& state_of(const SceneView& scene, uint32_t piece) noexcept {
  const float* const number = scene.numbers + scene.layers[piece].first_number;
  return *reinterpret_cast<const WallState*>(number + changeable_numbers_of(kind_of(scene, piece)));
}

// Where it is now: the numbers of the scene are the live ones.
SpacePlace origin_of(const SceneView& scene, uint32_t piece) noexcept {
  const PieceTable& table = piece_of(scene, piece);
  SpacePlace origin{{table.origin[0], table.origin[1], table.origin[2]},
                    {table.rest_m[0], table.rest_m[1], table.rest_m[2]}};
  if (table.slide != 0)
    origin.rest_m = origin.rest_m + state_of(scene, piece).slid_m * axis_of(slide_of(table));
  return origin;
}

// A plane that a point has to stay above: normal u >= -distance, for its way u.
struct Plane {
  uint32_t piece = 0;
  float distance_m = 0;
  SpaceVector normal;
  SpaceVector at;    ///< the point, from the origin of the piece
  float skin_m = 0;  ///< of a triangle: the plane is this far above it
  uint32_t triangle = kNoTriangle;
};

struct Planes {
  Plane at[kMostTouched];
  uint32_t count = 0;

  bool has(uint32_t piece) const noexcept {
    for (uint32_t i = 0; i < count; ++i)
      if (at[i].piece == piece) return true;
    return false;
  }
  // The nearest ones stay.
  void add(const Plane& plane) noexcept {
    uint32_t place = count;
    if (count < kMostTouched) {
      ++count;
    } else {
      place = 0;
      for (uint32_t i = 1; i < count; ++i)
        if (at[i].distance_m > at[place].distance_m) place = i;
      if (!(plane.distance_m < at[place].distance_m)) return;
    }
    at[place] = plane;
  }
};

// A way that planes allow, and what each of them adds to the straight one.
struct Goal {
  SpaceVector way;
  uint32_t count = 0;
  uint32_t plane[kMostHolding] = {};
  float push_m[kMostHolding] = {};
};

bool allowed(const Planes& planes, SpaceVector way) noexcept {
  for (uint32_t i = 0; i < planes.count; ++i) {
    const Plane& plane = planes.at[i];
    const float rounding_m = plane.skin_m > 0 ? plane.skin_m / 16 : kRounding_m;
    if (dot(plane.normal, way) < -plane.distance_m - rounding_m) return false;
  }
  return true;
}

// way = straight + sum of push normal, on all planes of the set: the pushes by Cramer's rule. False if the
// normals depend on each other, if a plane would pull, or if another plane forbids the way.
bool held_by(const Planes& planes, const uint32_t* set, uint32_t count, SpaceVector straight,
             Goal& goal) noexcept {
  constexpr float kLeastVolume = 1e-6F;
  constexpr int kTurns = 2;  // the second one adds what the first one lost by rounding
  float g01 = 0, g02 = 0, g12 = 0;
  SpaceVector n[kMostHolding];
  Goal found{straight, count, {}, {}};
  for (uint32_t i = 0; i < count; ++i) n[i] = planes.at[set[i]].normal, found.plane[i] = set[i];
  if (count > 1) g01 = dot(n[0], n[1]);
  if (count > 2) g02 = dot(n[0], n[2]), g12 = dot(n[1], n[2]);
  const float c0 = 1 - g12 * g12, c1 = g02 * g12 - g01, c2 = g01 * g12 - g02;
  const float volume = count < 2 ? 1 : count < 3 ? 1 - g01 * g01 : c0 + g01 * c1 + g02 * c2;
  if (!(volume > kLeastVolume)) return false;
  for (int turn = 0; turn < kTurns; ++turn) {
    float lack[kMostHolding] = {}, push[kMostHolding] = {};
    for (uint32_t i = 0; i < count; ++i) lack[i] = -planes.at[set[i]].distance_m - dot(n[i], found.way);
    if (count == 1) {
      push[0] = lack[0];
    } else if (count == 2) {
      push[0] = (lack[0] - g01 * lack[1]) / volume;
      push[1] = (lack[1] - g01 * lack[0]) / volume;
    } else {
      push[0] = (c0 * lack[0] + c1 * lack[1] + c2 * lack[2]) / volume;
      push[1] = (c1 * lack[0] + (1 - g02 * g02) * lack[1] + (g01 * g02 - g12) * lack[2]) / volume;
      push[2] = (c2 * lack[0] + (g01 * g02 - g12) * lack[1] + (1 - g01 * g01) * lack[2]) / volume;
    }
    for (uint32_t i = 0; i < count; ++i) {
      found.push_m[i] += push[i];
      if (!(found.push_m[i] >= 0)) return false;
      found.way = found.way + push[i] * n[i];
    }
    if (!allowed(planes, found.way)) continue;
    goal = found;
    return true;
  }
  return false;
}

// None of the sets fits by rounding alone: then it stays, held by the plane that is crossed most.
Goal nearest_allowed(const Planes& planes, SpaceVector straight) noexcept {
  Goal goal;
  if (allowed(planes, straight)) return {straight, 0, {}, {}};
  const uint32_t n = planes.count;
  for (uint32_t i = 0; i < n; ++i)
    if (const uint32_t set[] = {i}; held_by(planes, set, 1, straight, goal)) return goal;
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t j = i + 1; j < n; ++j)
      if (const uint32_t set[] = {i, j}; held_by(planes, set, 2, straight, goal)) return goal;
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t j = i + 1; j < n; ++j)
      for (uint32_t k = j + 1; k < n; ++k)
        if (const uint32_t set[] = {i, j, k}; held_by(planes, set, 3, straight, goal)) return goal;
  for (uint32_t i = 0; i < n; ++i) {
    const float lack_m = -planes.at[i].distance_m - dot(planes.at[i].normal, straight);
    if (lack_m > goal.push_m[0]) goal = {{}, 1, {i}, {lack_m}};
  }
  return goal;
}

// The tip of a cone holds a ghost as a plane across its way would.
SpaceVector normal_or(SpaceVector normal, SpaceVector way) noexcept {
  if (dot(normal, normal) > 0) return normal;
  const float size = length(way);
  if (!(size > 0)) return {0, 0, 1};
  return (-1 / size) * way;
}

float size_of(float value) noexcept {
  return value < 0 ? -value : value;
}

// Of the device, along a direction.
float most_force_n(const ForceSetup& setup, SpaceVector normal) noexcept {
  float most_n = setup.peak_n;
  for (uint32_t i = 0; i < setup.axis_count; ++i) {
    const ForceAxis& axis = setup.axes[i];
    const float share = axis.along == AxisAlong::x   ? normal.x
                        : axis.along == AxisAlong::y ? normal.y
                                                     : normal.z;
    const float size = size_of(share);
    if (axis.peak_n < most_n * size) most_n = axis.peak_n / size;
  }
  return most_n;
}

// The way of a goal on surfaces that bend towards it. The straight one is too long there: along it the
// squared distance from the hand has the second derivative 1 + sum of push x curvature, on a plane 1. The
// part back to the surfaces stays.
SpaceVector shortened(const SceneView& scene, const Planes& planes, const Goal& goal) noexcept {
  const float squared = dot(goal.way, goal.way);
  SpaceVector back;
  float bent = 0;
  for (uint32_t i = 0; i < goal.count; ++i) {
    const Plane& plane = planes.at[goal.plane[i]];
    back = back - plane.distance_m * plane.normal;
    const PieceTable& table = piece_of(scene, plane.piece);
    if (kind_of(scene, plane.piece) == SceneLayerKind::quadric)
      bent += goal.push_m[i] * bend_of(table, plane.at, goal.way);
    if (kind_of(scene, plane.piece) == SceneLayerKind::relief)
      bent += goal.push_m[i] * relief_bend(relief_piece(table), plane.at, goal.way);
  }
  if (!(bent > 0) || !(squared > 0)) return goal.way;
  const float share = squared / (squared + bent);
  return share * goal.way + (1 - share) * back;
}

// Of the triangles that the ghost met those that still hold it: by their plane; beside a triangle, by the
// plane across the way from its edge or corner, unless another plane is nearly the same.
[[gnu::noinline]] void add_triangles(const SceneView& scene, const SpacePlace& ghost,
                                     const float (&step_m)[3], GhostPoint::TouchedTriangles& touched,
                                     Planes& planes) noexcept {
  Planes beside;
  uint32_t kept = 0;
  for (uint32_t i = 0; i < touched.count; ++i) {
    const uint32_t piece = touched.piece[i], triangle = touched.triangle[i];
    const MeshTable& mesh = mesh_of(scene, piece);
    const SpaceVector from = difference(ghost, origin_of(scene, piece), step_m);
    const TriangleSide side = side_of(mesh, triangle, from);
    if (!is_held_by(mesh, side)) continue;
    touched.piece[kept] = piece, touched.triangle[kept++] = triangle;
    const float above_m = side.beside ? side.distance_m : side.above_m;
    (side.beside ? beside : planes)
        .add({piece, above_m - mesh.skin_m, side.away, from, mesh.skin_m, triangle});
  }
  touched.count = kept;
  for (uint32_t i = 0; i < beside.count; ++i) {
    bool known = false;
    for (uint32_t j = 0; j < planes.count; ++j)
      known = known || (planes.at[j].skin_m > 0 && dot(planes.at[j].normal, beside.at[i].normal) > kSameAway);
    if (!known) planes.add(beside.at[i]);
  }
}

// Nearer to a triangle than three quarters of its skin: it goes out first, and along the surface afterwards.
bool is_in_skin(const Planes& planes) noexcept {
  for (uint32_t i = 0; i < planes.count; ++i)
    if (planes.at[i].skin_m > 0 && planes.at[i].distance_m < -0.25F * planes.at[i].skin_m) return true;
  return false;
}

// In a full list it takes the place of one that does not hold the ghost: at most three do.
void touch(GhostPoint::TouchedTriangles& touched, uint32_t piece, uint32_t triangle, const Planes& planes,
           const Goal& goal) noexcept {
  static_assert(kMostHolding < kMostTouched);
  uint32_t place = touched.count;
  for (uint32_t i = 0; i < touched.count; ++i)
    if (touched.piece[i] == piece && touched.triangle[i] == triangle) return;
  for (uint32_t i = 0; i < touched.count && place == kMostTouched; ++i) {
    bool holds = false;
    for (uint32_t j = 0; j < goal.count; ++j) {
      const Plane& plane = planes.at[goal.plane[j]];
      holds = holds || (plane.piece == touched.piece[i] && plane.triangle == touched.triangle[i]);
    }
    if (!holds) place = i;
  }
  touched.piece[place] = piece, touched.triangle[place] = triangle;
  if (place == touched.count) ++touched.count;
}

// Of all meshes; `piece` is set if there is one.
[[gnu::noinline]] MeshHit first_triangle(const SceneView& scene, const SpacePlace& ghost, SpaceVector way,
                                         const float (&step_m)[3], uint32_t& piece) noexcept {
  MeshHit first;
  for (uint32_t i = 0; i < scene.layer_count; ++i) {
    if (!is_mesh(scene, i)) continue;
    const MeshTable& mesh = mesh_of(scene, i);
    const MeshHit hit = first_hit(mesh, difference(ghost, origin_of(scene, i), step_m), way);
    if (hit.part < first.part) first = hit, piece = i;
  }
  return first;
}

// A way below which a ghost on a mesh has come to rest: about what places round by.
float settled_on_meshes(const SceneView& scene) noexcept {
  float settled_m = 0;
  for (uint32_t i = 0; i < scene.layer_count; ++i) {
    if (!is_mesh(scene, i)) continue;
    const float own_m = mesh_of(scene, i).skin_m / 16;
    settled_m = own_m > settled_m ? own_m : settled_m;
  }
  return settled_m;
}

// The pushes of the planes without the skins that triangles have. Here and below not inlined: the frame of
// GhostPoint::follow has to fit a board.
[[gnu::noinline]] void take_off_skins(const Planes& with_skins, Goal& goal, SpaceVector straight) noexcept {
  Planes planes = with_skins;
  bool any = false;
  for (uint32_t i = 0; i < planes.count; ++i) {
    planes.at[i].distance_m += planes.at[i].skin_m;
    any = any || planes.at[i].skin_m > 0;
  }
  Goal bare;
  if (!any || goal.count == 0) return;
  if (held_by(planes, goal.plane, goal.count, straight, bare)) {
    goal = bare;
    return;
  }
  for (uint32_t i = 0; i < goal.count; ++i) {
    const float push_m = goal.push_m[i] - planes.at[goal.plane[i]].skin_m;
    goal.push_m[i] = push_m > 0 ? push_m : 0;
  }
}

[[gnu::noinline]] void hold(const Planes& planes, Goal goal, SpaceVector straight,
                            GhostPoint::Holding& holding) noexcept {
  take_off_skins(planes, goal, straight);
  holding.count = goal.count;
  for (uint32_t i = 0; i < goal.count; ++i) {
    const Plane& plane = planes.at[goal.plane[i]];
    holding.piece[i] = plane.piece;
    holding.normal[i] = plane.normal;
    holding.depth_m[i] = goal.push_m[i];
  }
}

bool is_inside(const SceneView& scene, const SpacePlace& place, const float (&step_m)[3]) noexcept {
  for (uint32_t i = 0; i < scene.layer_count; ++i) {
    const PieceTable& table = piece_of(scene, i);
    if (surface_at(kind_of(scene, i), table, difference(place, origin_of(scene, i), step_m)).distance_m <
        -kInside_m)
      return true;
  }
  return false;
}

// The table is in the memory of the kernel if it is clay.
[[gnu::noinline]] void press(const PieceTable& table, float stiffness, float depth_m,
                             SpaceVector on) noexcept {
  auto& relief = const_cast<ReliefPieceTable&>(relief_piece(table));
  if (relief.clay.force_n > 0 && spring_force(table, stiffness, depth_m) > relief.clay.force_n)
    press_clay(relief, on);
}

}  // namespace

void GhostPoint::move(SpaceVector way, const float (&step_m)[3]) noexcept {
  SpaceVector rest = ghost_.rest_m + way;
  float* const along[3] = {&rest.x, &rest.y, &rest.z};
  for (int i = 0; i < 3; ++i) {
    const float whole = *along[i] / step_m[i];
    if (!within(whole, -1e9F, 1e9F)) continue;
    const auto counts = static_cast<int32_t>(whole < 0 ? whole - 0.5F : whole + 0.5F);
    ghost_.counts[i] =
        static_cast<int32_t>(static_cast<uint32_t>(ghost_.counts[i]) + static_cast<uint32_t>(counts));
    *along[i] -= static_cast<float>(counts) * step_m[i];
  }
  ghost_.rest_m = rest;
}

// On one curved piece: to the place nearest to the hand, if that is near and nothing is between.
[[gnu::noinline]] bool GhostPoint::settle_on(const SceneView& scene, const SpacePlace& hand,
                                             const float (&step_m)[3], uint32_t touched,
                                             Holding& holding) noexcept {
  const uint32_t piece = holding.piece[0];
  const SceneLayerKind kind = kind_of(scene, piece);
  if (kind == SceneLayerKind::plane || kind == SceneLayerKind::mesh) return false;
  const PieceTable& table = piece_of(scene, piece);
  const SpacePlace origin = origin_of(scene, piece);
  const SpaceVector at = difference(ghost_, origin, step_m), to = difference(hand, origin, step_m);
  SpaceVector nearest;
  const bool slides = kind == SceneLayerKind::relief;
  if (slides)
    nearest = slid_on_relief(relief_piece(table), to, at);
  else if (!nearest_on(kind, table, to, at, nearest))
    return false;
  const SpaceVector normal = surface_at(kind, table, nearest).normal,
                    before = surface_at(kind, table, at).normal, pull = nearest - to, way = nearest - at;
  if (!slides && !(dot(normal, before) >= kSameSide)) return false;
  if (!slides && !(dot(pull, normal) > 0)) return false;
  if (!(length(pull) <= length(at - to) + (slides ? kTouch_m + kInRelief_m : kTouch_m))) return false;
  for (uint32_t i = 0; i < scene.layer_count; ++i) {
    if (i == piece) continue;
    const PieceTable& other = piece_of(scene, i);
    const SpaceVector from = difference(ghost_, origin_of(scene, i), step_m);
    if (surface_at(kind_of(scene, i), other, from + way).distance_m < -kRounding_m) return false;
    if ((touched >> i & 1) == 0 && entry_of(kind_of(scene, i), other, from, way) <= 1) return false;
  }
  uint32_t mesh = 0;
  if (first_triangle(scene, ghost_, way, step_m, mesh).part <= 1) return false;
  move(way, step_m);
  // On a relief it may be on its way, also where the hand is above the plane that touches it there.
  if (!(dot(pull, normal) > 0)) holding.count = 0;
  holding.normal[0] = normal;
  holding.depth_m[0] = slides ? dot(pull, normal) : length(pull);
  return true;
}

GhostPoint::Holding GhostPoint::follow(const SceneView& scene, const SpacePlace& hand,
                                       const float (&step_m)[3]) noexcept {
  Holding holding, of_last;
  SpacePlace last = ghost_;  // at which the ghost was outside
  bool outside = false;
  uint32_t touched = 0;
  slides_ = 0;
  static_assert(kMostPieces <= 32);
  const float settled_m = settled_on_meshes(scene);
  for (int pass = 0; pass <= kGhostPasses; ++pass) {  // the last one moves no more, and gives the force
    const SpaceVector straight = difference(hand, ghost_, step_m);
    Planes planes;
    float nearest_m = kFarthestInSpace_m;
    for (uint32_t i = 0; i < scene.layer_count; ++i) {
      if (is_mesh(scene, i)) continue;
      const PieceTable& table = piece_of(scene, i);
      const SpaceVector from = difference(ghost_, origin_of(scene, i), step_m);
      const PieceSurface at = surface_at(kind_of(scene, i), table, from);
      nearest_m = at.distance_m < nearest_m ? at.distance_m : nearest_m;
      if (at.distance_m <= kTouch_m) touched |= UINT32_C(1) << i;
      if (touched >> i & 1) planes.add({i, at.distance_m, normal_or(at.normal, straight), from});
    }
    add_triangles(scene, ghost_, step_m, touched_, planes);
    const Goal goal = nearest_allowed(planes, straight);
    hold(planes, goal, straight, holding);
    if (nearest_m >= -kInside_m) last = ghost_, of_last = holding, outside = true;
    const bool settles = goal.count == 1 && (kind_of(scene, holding.piece[0]) != SceneLayerKind::relief ||
                                             ++slides_ <= kMostSlides);
    if (settles && settle_on(scene, hand, step_m, touched, holding)) {
      if (holding.count > 0) break;
      continue;
    }
    if (pass == kGhostPasses) break;
    const bool out = (nearest_m < -kInside_m && pass + kPassesOut >= kGhostPasses) || is_in_skin(planes);
    SpaceVector way = out ? nearest_allowed(planes, {}).way : shortened(scene, planes, goal);
    if (settled_m > 0 && length(way) <= settled_m) break;
    // A surface that bends towards the ghost: a shorter step, so that it stays near.
    for (int halved = 0; halved < 4; ++halved) {
      float deepest_m = 0;
      for (uint32_t i = 0; i < planes.count; ++i) {
        const uint32_t piece = planes.at[i].piece;
        const PieceTable& table = piece_of(scene, piece);
        const float distance_m = surface_at(kind_of(scene, piece), table,
                                            difference(ghost_, origin_of(scene, piece), step_m) + way)
                                     .distance_m;
        deepest_m = distance_m < deepest_m ? distance_m : deepest_m;
      }
      if (-deepest_m <= kTouch_m + kDeepest * length(way)) break;
      way = 0.5F * way;
    }
    float part = 1;
    uint32_t met = scene.layer_count;
    for (uint32_t i = 0; i < scene.layer_count; ++i) {
      const PieceTable& table = piece_of(scene, i);
      const SpaceVector from = difference(ghost_, origin_of(scene, i), step_m);
      const bool touches = planes.has(i), relief = kind_of(scene, i) == SceneLayerKind::relief;
      if (touches && !relief && kind_of(scene, i) != SceneLayerKind::quadric) continue;
      const float entry = !touches ? entry_of(kind_of(scene, i), table, from, way)
                          : relief ? relief_entry(relief_piece(table), from, way, kInRelief_m)
                                   : return_to(table, from, way, kLeaves_m);
      if (entry <= part) part = entry, met = i;
    }
    uint32_t mesh = 0;
    if (const MeshHit hit = first_triangle(scene, ghost_, way, step_m, mesh); hit.part <= part) {
      part = hit.part, met = mesh;
      if (hit.triangle != kNoTriangle) touch(touched_, mesh, hit.triangle, planes, goal);
    }
    if (met < scene.layer_count) touched |= UINT32_C(1) << met;
    move(part * way, step_m);
    if (met == scene.layer_count && length(way) <= kSettled_m) break;
  }
  if (!outside || !is_inside(scene, ghost_, step_m)) return holding;
  ghost_ = last;
  return of_last;
}

// Of all triangles of a mesh that hold the ghost.
SpaceVector GhostPoint::push_of(const Holding& holding, uint32_t piece) noexcept {
  SpaceVector push;
  for (uint32_t i = 0; i < holding.count; ++i)
    if (holding.piece[i] == piece) push = push + holding.depth_m[i] * holding.normal[i];
  return push;
}

// The part of a way that the ghost is free to go with a piece that takes it along; a piece that it touches
// stops it only where the way leads into it.
[[gnu::noinline]] float GhostPoint::free_part(const SceneView& scene, uint32_t moved, SpaceVector way,
                                              const float (&step_m)[3]) const noexcept {
  constexpr float kInto = 1e-3F;  // sine of the least angle: less is rounding, or a bend
  float free = 1;
  for (uint32_t i = 0; i < scene.layer_count; ++i) {
    if (i == moved) continue;
    const PieceTable& table = piece_of(scene, i);
    const SpaceVector from = difference(ghost_, origin_of(scene, i), step_m);
    const PieceSurface at = surface_at(kind_of(scene, i), table, from);
    float part = 1;
    if (is_mesh(scene, i))
      part = first_hit(mesh_of(scene, i), from, way).part;
    else if (at.distance_m > kTouch_m)
      part = entry_of(kind_of(scene, i), table, from, way);
    else if (dot(at.normal, way) < -kInto * length(way))
      part = 0;
    free = part < free ? part : free;
  }
  return free;
}

// The pieces that slide go on by a tick. One that would pass the ghost takes it along, and stops where
// another piece holds the ghost back: so the ghost is never in it.
[[gnu::noinline]] void GhostPoint::move_slides(const SceneView& scene, float* live, bool follows,
                                               const float (&step_m)[3], float tick_s) noexcept {
  for (uint32_t i = 0; i < scene.layer_count; ++i) {
    const PieceTable& table = piece_of(scene, i);
    if (table.slide == 0) continue;
    float* const number = live + scene.layers[i].first_number;
    auto& state = *reinterpret_cast<WallState*>(number + changeable_numbers_of(kind_of(scene, i)));
    const SpaceVector axis = axis_of(slide_of(table));
    float way_m = slide_way(slide_of(table), state, tick_s), meets = 1;
    const bool stops = way_m != tick_s * state.slid_mps;
    if (follows && way_m != 0) {
      const SpaceVector from = difference(ghost_, origin_of(scene, i), step_m), back = -way_m * axis;
      meets = is_mesh(scene, i) ? first_hit(mesh_of(scene, i), from, back).part
                                : entry_of(kind_of(scene, i), table, from, back);
    }
    float free = 1;
    if (meets < 1) {
      const SpaceVector carried = (1 - meets) * way_m * axis;
      free = free_part(scene, i, carried, step_m);
      move(free * carried, step_m);
      way_m *= meets + free * (1 - meets);
    }
    state.slid_m += way_m;
    if (stops || free < 1) state.slid_mps = 0;
  }
}

SpaceVector GhostPoint::force(const SceneView& block, float* live, const SpaceHand& hand,
                              const float (&step_m)[3], const ForceSetup& setup) noexcept {
  const SceneView scene = block.as_in(live);
  const SpacePlace place{{hand.counts[0], hand.counts[1], hand.counts[2]}, {}};
  const auto far = [&](const SpacePlace& a, const SpacePlace& b) {
    return !(length(difference(a, b, step_m)) <= kFarthestInSpace_m);
  };
  bool beyond = false;
  for (uint32_t i = 0; i < scene.layer_count; ++i) beyond = beyond || far(place, origin_of(scene, i));
  const bool arrives = !placed_ || beyond || far(place, ghost_);
  if (arrives) ghost_ = place, touched_.count = 0;
  placed_ = true;
  const bool adds = scene.patches[0].adds != 0;
  Holding holding;
  if (!beyond && !adds) holding = follow(scene, place, step_m);
  SpaceVector sum;
  bool slides = false;
  for (uint32_t i = 0; i < scene.layer_count; ++i) {
    const PieceTable& table = piece_of(scene, i);
    const SpaceVector from = difference(place, origin_of(scene, i), step_m);
    const PieceSurface at = surface_at(kind_of(scene, i), table, beyond ? SpaceVector{} : from);
    WallTouch touch{0, beyond ? kFarthestInSpace_m : at.distance_m, 0, 0, 0, 1 / setup.rate_hz};
    SpaceVector normal = at.normal;
    for (uint32_t j = 0; j < holding.count; ++j)
      if (holding.piece[j] == i) touch.depth_m = holding.depth_m[j], normal = holding.normal[j];
    float* const number = live + scene.layers[i].first_number;
    auto& state = *reinterpret_cast<WallState*>(number + changeable_numbers_of(kind_of(scene, i)));
    if (is_mesh(scene, i)) {
      normal = push_of(holding, i);
      touch.depth_m = length(normal);
      if (touch.depth_m > 0) normal = (1 / touch.depth_m) * normal;
      if (state.touched != 0 && !beyond && is_near(mesh_of(scene, i), from, kLetGo_m)) touch.outside_m = 0;
    }
    if (is_volume(scene, i) && !beyond) {
      auto& volume = const_cast<VolumeTable&>(table_of<VolumeTable>(scene, scene.layers[i]));
      const VolumeTouch in = touch_volume(volume, hand.counts, number[kPieceStiffness]);
      touch.depth_m = length(in.push_m), touch.outside_m = in.outside_m;
      if (touch.depth_m > 0) normal = (1 / touch.depth_m) * in.push_m;
    }
    if (adds && !beyond && at.distance_m < 0) {
      SpaceVector nearest;
      const SceneLayerKind kind = kind_of(scene, i);
      const bool quadric = kind == SceneLayerKind::quadric;
      const bool found = quadric ? nearest_face(table, from, nearest)
                                 : nearest_on(kind, table, from, from - at.distance_m * normal, nearest);
      touch.depth_m = found ? length(nearest - from) : quadric ? 0 : -at.distance_m;
      if (found && touch.depth_m > 0) normal = (1 / touch.depth_m) * (nearest - from);
    }
    SpaceVector speed_mps = hand.speed_mps;
    if (table.slide != 0) speed_mps = speed_mps - state.slid_mps * axis_of(slide_of(table));
    touch.speed_mps = dot(speed_mps, normal);
    touch.most_force_n = most_force_n(setup, normal);
    touch.grain_m =
        size_of(normal.x) * step_m[0] + size_of(normal.y) * step_m[1] + size_of(normal.z) * step_m[2];
    float normal_n = wall_force(number, table, state, touch);
    const SpaceVector on = is_volume(scene, i) ? from
                           : adds              ? from + touch.depth_m * normal
                                               : difference(ghost_, origin_of(scene, i), step_m);
    if (arrives)
      state.anchor_m = state.last_m = on;  // a hand that begins in a piece is not held from elsewhere
    const SpaceVector of_texture =
        texture_force(table, number, state, normal_n, normal, on, speed_mps, setup.rate_hz);
    const SpaceVector own =
        normal_n * normal + of_texture + friction_force(number, state, normal_n, normal, on, speed_mps);
    sum = sum + own;
    if (kind_of(scene, i) == SceneLayerKind::relief) press(table, number[kPieceStiffness], touch.depth_m, on);
    if (table.slide == 0) continue;
    push_slide(slide_of(table), state, -dot(own, axis_of(slide_of(table))));
    slides = true;
  }
  if (slides) move_slides(scene, live, !beyond && !adds, step_m, 1 / setup.rate_hz);
  return sum;
}

}  // namespace tacto::core

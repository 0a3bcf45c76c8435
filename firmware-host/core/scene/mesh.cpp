// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/mesh.hpp"

namespace tacto::core {
namespace {

constexpr int kMostSteps = 16;         // of Newton's method; on a plane one, on edges usually three
constexpr float kArrived = 1.0625F;    // of the skin, or half of it
constexpr float kBehind = -0.05F;      // sine of the angle below a plane from which its edges are met
constexpr float kLeastWay_m = 1e-18F;  // along an axis, so that its reciprocal is a number

constexpr SpaceVector cross(SpaceVector a, SpaceVector b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

float larger(float a, float b) noexcept {
  return a > b ? a : b;
}
float smaller(float a, float b) noexcept {
  return a < b ? a : b;
}

struct Triangle {
  SpaceVector corner[3], edge[3], normal;
};

SpaceVector corner_of(const MeshTable& table, uint32_t triangle, uint32_t corner) noexcept {
  const float* const at =
      vertices_of(table) + 3 * static_cast<uint64_t>(triangles_of(table)[3 * triangle + corner]);
  return {at[0], at[1], at[2]};
}

// The largest component is 1 before the root is taken: also the square of a small area is a number.
Triangle triangle_of(const MeshTable& table, uint32_t triangle) noexcept {
  Triangle t;
  for (uint32_t i = 0; i < 3; ++i) t.corner[i] = corner_of(table, triangle, i);
  for (uint32_t i = 0; i < 3; ++i) t.edge[i] = t.corner[i < 2 ? i + 1 : 0] - t.corner[i];
  const SpaceVector area = cross(t.edge[0], t.edge[1]);
  const float most =
      larger(larger(larger(area.x, -area.x), larger(area.y, -area.y)), larger(area.z, -area.z));
  if (!(most > 1e-30F)) return t;
  const SpaceVector scaled = (1 / most) * area;
  t.normal = (1 / length(scaled)) * scaled;
  return t;
}

// A place from the corners of a triangle: nearby it is rounded less than from the origin.
struct FromCorners {
  SpaceVector from[3];

  FromCorners(const Triangle& t, SpaceVector place) noexcept {
    for (int i = 0; i < 3; ++i) from[i] = place - t.corner[i];
  }
  FromCorners moved(SpaceVector way) const noexcept {
    FromCorners there = *this;
    for (SpaceVector& each : there.from) each = each + way;
    return there;
  }
};

// Inside of all three edges the nearest place is that of the plane; else it is on an edge that the place is
// outside of.
TriangleSide side_of(const Triangle& t, const FromCorners& place) noexcept {
  TriangleSide side;
  side.normal = t.normal;
  side.above_m = dot(t.normal, place.from[0]);
  float nearest_m2 = -1;
  SpaceVector away;
  for (uint32_t i = 0; i < 3; ++i) {
    const SpaceVector from = place.from[i];
    if (dot(cross(t.normal, t.edge[i]), from) >= 0 && dot(t.normal, t.normal) > 0) continue;
    const float along = dot(from, t.edge[i]), all = dot(t.edge[i], t.edge[i]);
    const SpaceVector beside = along <= 0    ? from
                               : along < all ? from - (along / all) * t.edge[i]
                                             : from - t.edge[i];
    const float squared = dot(beside, beside);
    if (nearest_m2 < 0 || squared < nearest_m2) nearest_m2 = squared, away = beside;
  }
  if (nearest_m2 < 0) {
    side.distance_m = side.above_m < 0 ? -side.above_m : side.above_m;
    side.away = side.above_m < 0 ? -1 * t.normal : t.normal;
    return side;
  }
  side.beside = true;
  side.distance_m = __builtin_sqrtf(nearest_m2);
  side.away = side.distance_m > 0 ? (1 / side.distance_m) * away : t.normal;
  return side;
}

// Planes that separate a way from a triangle and what is within `reach_m` of it: its own, and those of its
// edges.
bool is_apart(const Triangle& t, SpaceVector place, SpaceVector way, float reach_m) noexcept {
  const float from_m = dot(t.normal, place - t.corner[0]), to_m = from_m + dot(t.normal, way);
  if (smaller(from_m, to_m) > reach_m || larger(from_m, to_m) < -reach_m) return true;
  for (uint32_t i = 0; i < 3; ++i) {
    const SpaceVector inwards = cross(t.normal, t.edge[i]);
    const float from = dot(inwards, place - t.corner[i]), nearest = larger(from, from + dot(inwards, way));
    if (nearest < 0 && nearest * nearest > reach_m * reach_m * dot(t.edge[i], t.edge[i])) return true;
  }
  return false;
}

struct Meeting {
  float part = 2;  // at which the place is half a skin away, above the most: none
  float stop = 2;  // before it, at which it is a skin away, or 0
};

// Up to the part `most`. Beside an edge the direction from it is rounded by kEdgeRounding: the way may be as
// much steeper than it seems.
Meeting meeting_of(const Triangle& t, SpaceVector place, SpaceVector way, float skin_m, float most) noexcept {
  const FromCorners start(t, place);
  const float size_m = length(way), rounding_m = 0x1p-22F * (length(start.from[0]) + size_m);
  const Meeting none{2 * most + 1, 2};
  Meeting meeting{0, -1};
  for (int i = 0;; ++i) {
    const TriangleSide side = side_of(t, start.moved(meeting.part * way));
    float slope_m = dot(side.away, way);
    if (side.beside) slope_m -= size_m * smaller(0.125F, rounding_m / side.distance_m);
    if (!(slope_m < 0)) return none;
    if (meeting.stop < 0 && side.distance_m <= kArrived * skin_m) meeting.stop = meeting.part;
    const bool arrived = side.distance_m <= 0.5F * kArrived * skin_m;
    if (arrived || i == kMostSteps) {
      if (meeting.stop < 0 || !arrived) meeting.stop = meeting.part;
      return side.above_m >= kBehind * side.distance_m ? meeting : none;
    }
    meeting.part += (side.distance_m - (meeting.stop < 0 ? 1 : 0.5F) * skin_m) / -slope_m;
    if (!(meeting.part <= most)) return none;
  }
}

// The parts of a way in a box; none if `from` is the larger one.
struct Crossing {
  float from = 0, to = 1;
};

struct Way {
  float place_m[3], by[3];  // reciprocals of the way along the axes

  Way(SpaceVector place, SpaceVector way) noexcept : place_m{place.x, place.y, place.z}, by{} {
    const float along[3] = {way.x, way.y, way.z};
    for (int i = 0; i < 3; ++i)
      by[i] = 1 / (within_least(along[i]) ? (along[i] < 0 ? -kLeastWay_m : kLeastWay_m) : along[i]);
  }
  static bool within_least(float value) noexcept { return value < kLeastWay_m && value > -kLeastWay_m; }

  Crossing through(const MeshNode& box, float most) const noexcept {
    Crossing crossing{0, most};
    for (int i = 0; i < 3; ++i) {
      const float a = (box.least_m[i] - place_m[i]) * by[i], b = (box.most_m[i] - place_m[i]) * by[i];
      crossing.from = larger(crossing.from, smaller(a, b));
      crossing.to = smaller(crossing.to, larger(a, b));
    }
    return crossing;
  }
};

// In single precision a place is exact enough within a few extents of the mesh.
MeshHit hit_near(const MeshTable& table, SpaceVector place, SpaceVector way) noexcept {
  const float skin_m = table.skin_m, size_m = length(way);
  MeshHit hit;
  if (!(size_m > 0)) return hit;
  const float same = 0.0625F * skin_m / size_m;
  float most = 1, steepest = 0, soonest = 2;
  const Way line(place, way);
  const MeshNode* const nodes = nodes_of(table);
  for (uint32_t i = 0; i < table.nodes;) {
    const MeshNode& node = nodes[i];
    const Crossing crossing = line.through(node, most);
    if (!(crossing.from <= crossing.to)) {
      i = node.skip;
      continue;
    }
    const uint32_t first = node.leaf / (kMostLeafTriangles + 1), count = node.leaf % (kMostLeafTriangles + 1);
    for (uint32_t j = first; j < first + count; ++j) {
      const Triangle t = triangle_of(table, j);
      const float slope_m = dot(t.normal, way);
      if (!(dot(t.normal, t.normal) > 0) || is_apart(t, place, most * way, skin_m)) continue;
      const Meeting meeting = meeting_of(t, place, way, skin_m, most);
      if (!(meeting.part <= most)) continue;
      if (meeting.part < soonest - same || slope_m < steepest) hit = {meeting.stop, j}, steepest = slope_m;
      soonest = smaller(soonest, meeting.part);
      hit.part = smaller(hit.part, soonest);
      most = smaller(1, soonest + same);
    }
    ++i;
  }
  return hit;
}

}  // namespace

TriangleSide side_of(const MeshTable& table, uint32_t triangle, SpaceVector place) noexcept {
  const Triangle t = triangle_of(table, triangle);
  return side_of(t, FromCorners(t, place));
}

MeshHit first_hit(const MeshTable& table, SpaceVector place, SpaceVector way) noexcept {
  constexpr float kAll = 3;  // half extents: more than a way across the mesh from beside it
  const Crossing crossing = Way(place, way).through(nodes_of(table)[0], 1);
  if (!(crossing.from <= crossing.to)) return {};
  const float size_m = length(way), half_m = table.piece.form[kPieceSize];
  if (!(size_m > kAll * half_m)) return hit_near(table, place, way);
  if (crossing.from * size_m > kAll * half_m) return {crossing.from - half_m / size_m, kNoTriangle};
  const float share = smaller(1, crossing.to + half_m / size_m);
  MeshHit hit = hit_near(table, place, share * way);
  hit.part *= share;
  return hit.triangle == kNoTriangle ? MeshHit{} : hit;
}

bool is_near(const MeshTable& table, SpaceVector place, float reach_m) noexcept {
  const MeshNode* const nodes = nodes_of(table);
  const float at[3] = {place.x, place.y, place.z};
  for (uint32_t i = 0; i < table.nodes;) {
    const MeshNode& node = nodes[i];
    bool apart = false;
    for (int k = 0; k < 3; ++k)
      apart = apart || at[k] < node.least_m[k] - reach_m || at[k] > node.most_m[k] + reach_m;
    if (apart) {
      i = node.skip;
      continue;
    }
    const uint32_t first = node.leaf / (kMostLeafTriangles + 1), count = node.leaf % (kMostLeafTriangles + 1);
    for (uint32_t j = first; j < first + count; ++j)
      if (side_of(table, j, place).distance_m <= reach_m) return true;
    ++i;
  }
  return false;
}

}  // namespace tacto::core

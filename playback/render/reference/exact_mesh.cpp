// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tacto::playback {
namespace {

using ExactPlace = ExactMesh::Place;

constexpr double kSameDistance_m = kExactSkin_m / 16;

ExactPlace minus(const ExactPlace& a, const ExactPlace& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
ExactPlace plus(const ExactPlace& a, double by, const ExactPlace& b) {
  return {a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2]};
}
double scalar(const ExactPlace& a, const ExactPlace& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double norm_of(const ExactPlace& a) {
  return std::sqrt(scalar(a, a));
}
ExactPlace vector_product(const ExactPlace& a, const ExactPlace& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Ericson, Real-Time Collision Detection, 5.1.5: by the regions of the corners, edges and the face.
std::pair<ExactPlace, bool> nearest_on_triangle(const ExactPlace& p, const ExactPlace& a, const ExactPlace& b,
                                                const ExactPlace& c) {
  const ExactPlace ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bp = minus(p, b), cp = minus(p, c);
  const double d1 = scalar(ab, ap), d2 = scalar(ac, ap), d3 = scalar(ab, bp), d4 = scalar(ac, bp),
               d5 = scalar(ab, cp), d6 = scalar(ac, cp);
  if (d1 <= 0 && d2 <= 0) return {a, true};
  if (d3 >= 0 && d4 <= d3) return {b, true};
  if (const double vc = d1 * d4 - d3 * d2; vc <= 0 && d1 >= 0 && d3 <= 0)
    return {plus(a, d1 / (d1 - d3), ab), true};
  if (d6 >= 0 && d5 <= d6) return {c, true};
  if (const double vb = d5 * d2 - d1 * d6; vb <= 0 && d2 >= 0 && d6 <= 0)
    return {plus(a, d2 / (d2 - d6), ac), true};
  if (const double va = d3 * d6 - d5 * d4; va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {plus(b, (d4 - d3) / ((d4 - d3) + (d5 - d6)), minus(c, b)), true};
  const ExactPlace n = vector_product(ab, ac);
  return {plus(p, -scalar(n, ap) / scalar(n, n), n), false};
}

}  // namespace

ExactMesh::ExactMesh(std::shared_ptr<const schema::Mesh> mesh, const ExactPlace& origin_m)
    : mesh_(std::move(mesh)), origin_m_(origin_m) {}

ExactMesh::Side ExactMesh::side_of(std::size_t triangle, const ExactPlace& place_m) const {
  const auto& [i, j, k] = mesh_->triangles[triangle];
  const ExactPlace &a = mesh_->vertices_m[i], &b = mesh_->vertices_m[j], &c = mesh_->vertices_m[k];
  const ExactPlace p = minus(place_m, origin_m_), area = vector_product(minus(b, a), minus(c, a));
  Side side;
  side.normal = plus({}, 1 / norm_of(area), area);
  side.above_m = scalar(side.normal, minus(p, a));
  const auto [nearest, beside] = nearest_on_triangle(p, a, b, c);
  side.beside = beside;
  const ExactPlace way = minus(p, nearest);
  side.distance_m = beside ? norm_of(way) : std::abs(side.above_m);
  side.away = !beside               ? plus({}, side.above_m < 0 ? -1 : 1, side.normal)
              : side.distance_m > 0 ? plus({}, 1 / side.distance_m, way)
                                    : side.normal;
  return side;
}

double ExactMesh::distance_m(const ExactPlace& place_m) const {
  double nearest_m = INFINITY;
  for (std::size_t i = 0; i < mesh_->triangles.size(); ++i)
    nearest_m = std::min(nearest_m, side_of(i, place_m).distance_m);
  return nearest_m;
}

// Of each triangle that the box around the way reaches: Newton's method from the start of the way.
std::optional<ExactMesh::Hit> ExactMesh::first_hit(const ExactPlace& from_m, const ExactPlace& way_m) const {
  const double size_m = norm_of(way_m);
  const ExactPlace from = minus(from_m, origin_m_), to = plus(from, 1, way_m);
  std::optional<Hit> first;
  double soonest = 1, steepest = 0;
  for (std::size_t i = 0; i < mesh_->triangles.size() && size_m > 0; ++i) {
    bool apart = false;
    for (std::size_t axis = 0; axis < 3 && !apart; ++axis) {
      const auto& t = mesh_->triangles[i];
      const auto& v = mesh_->vertices_m;
      const auto [low, high] = std::minmax({v[t[0]][axis], v[t[1]][axis], v[t[2]][axis]});
      apart = std::max(from[axis], to[axis]) < low - kExactSkin_m ||
              std::min(from[axis], to[axis]) > high + kExactSkin_m;
    }
    if (apart) continue;
    double part = 0, stop = -1;
    for (;;) {
      const Side side = side_of(i, plus(from_m, part, way_m));
      const double slope_m = scalar(side.away, way_m), rounding_m = side.beside ? 1e-6 * size_m : 0;
      if (!(slope_m - rounding_m < 0) || part > soonest + kSameDistance_m / size_m) break;
      if (stop < 0 && side.distance_m <= 1.03 * kExactSkin_m) stop = part;
      if (side.distance_m <= 0.51 * kExactSkin_m) {
        if (side.above_m < -0.05 * side.distance_m) break;
        const double along_m = scalar(side.normal, way_m);
        if (!first || part < soonest - kSameDistance_m / size_m || along_m < steepest)
          first = Hit{stop, i}, steepest = along_m;
        soonest = std::min(soonest, part);
        first->part = std::min(first->part, soonest);
        break;
      }
      // The distance is convex: the tangent is below it.
      part += (side.distance_m - (stop < 0 ? 1.0 : 0.5) * kExactSkin_m) / (rounding_m - slope_m);
    }
  }
  return first;
}

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/stability/acting_patches.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace tacto::playback {
namespace {

// How far beside a crossing a place is tested: below every encoder step that is of use on a travel of metres.
constexpr double kBeside_m = 1e-9;

struct Point {
  double x = 0, y = 0;
  Point plus(double factor, Point other) const { return {x + factor * other.x, y + factor * other.y}; }
};

struct Rectangle {
  Point centre, along, across;  // unit vectors of its axes
  double half_width = 0, half_height = 0;

  bool contains(Point place) const {
    const Point from = place.plus(-1, centre);
    return std::abs(from.x * along.x + from.y * along.y) <= half_width &&
           std::abs(from.x * across.x + from.y * across.y) <= half_height;
  }
};

// Where two edges meet, with their directions.
struct Vertex {
  Point place, first, second;
};

struct PatchEdge {
  Point middle, direction;
  double half = 0;
};

Rectangle rectangle_of(const schema::Patch& patch) {
  const double angle = patch.angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  return {{patch.x_m, patch.y_m}, {c, s}, {-s, c}, patch.width_m / 2, patch.height_m / 2};
}

// An axis that the device does not have stays at 0.
Rectangle travel_of(const schema::Device& device) {
  Rectangle travel{{0, 0}, {1, 0}, {0, 1}, 0, 0};
  for (const schema::DeviceAxis& axis : device.axes) {
    const double middle = (axis.travel_from_m + axis.travel_to_m) / 2;
    const double half = (axis.travel_to_m - axis.travel_from_m) / 2;
    if (axis.name == "z") continue;
    (axis.name == "x" ? travel.centre.x : travel.centre.y) = middle;
    (axis.name == "x" ? travel.half_width : travel.half_height) = half;
  }
  return travel;
}

void add_edges_and_corners(const Rectangle& r, std::vector<PatchEdge>& edges, std::vector<Vertex>& vertices) {
  for (const double sign : {-1.0, 1.0}) {
    edges.push_back({r.centre.plus(sign * r.half_height, r.across), r.along, r.half_width});
    edges.push_back({r.centre.plus(sign * r.half_width, r.along), r.across, r.half_height});
    for (const double other : {-1.0, 1.0})
      vertices.push_back({r.centre.plus(sign * r.half_width, r.along).plus(other * r.half_height, r.across),
                          r.along, r.across});
  }
}

void add_crossing(const PatchEdge& a, const PatchEdge& b, std::vector<Vertex>& vertices) {
  const double cross = a.direction.x * b.direction.y - a.direction.y * b.direction.x;
  if (std::abs(cross) < 1e-12) return;
  const Point between = b.middle.plus(-1, a.middle);
  const double on_a = (between.x * b.direction.y - between.y * b.direction.x) / cross;
  const double on_b = (between.x * a.direction.y - between.y * a.direction.x) / cross;
  if (std::abs(on_a) > a.half + kBeside_m || std::abs(on_b) > b.half + kBeside_m) return;
  vertices.push_back({a.middle.plus(on_a, a.direction), a.direction, b.direction});
}

}  // namespace

PatchStack::PatchStack(const std::vector<schema::Patch>& patches)
    : patches_(patches), topmost_first_(patches.size()) {
  std::iota(topmost_first_.rbegin(), topmost_first_.rend(), std::size_t{0});
  std::ranges::stable_sort(topmost_first_, std::ranges::greater(),
                           [&](std::size_t i) { return patches[i].order; });
}

std::vector<std::size_t> PatchStack::acting_at(double x_m, double y_m) const {
  std::vector<std::size_t> acting;
  for (bool covered = false; const std::size_t i : topmost_first_) {
    const bool adds = patches_[i].combine == schema::PatchCombine::add;
    const double from_x = x_m - patches_[i].x_m, from_y = y_m - patches_[i].y_m;
    const double width = patches_[i].width_m, height = patches_[i].height_m;
    const bool near = 4 * (from_x * from_x + from_y * from_y) < 1.1 * (width * width + height * height);
    if ((covered && !adds) || !near || !rectangle_of(patches_[i]).contains({x_m, y_m})) continue;
    covered = covered || !adds;
    acting.push_back(i);
  }
  return acting;
}

std::vector<ActingPatches> acting_patches(const std::vector<schema::Patch>& patches,
                                          const schema::Device& device) {
  const PatchStack stack(patches);
  const Rectangle travel = travel_of(device);
  std::vector<PatchEdge> edges;
  std::vector<Vertex> vertices;
  for (const schema::Patch& patch : patches) add_edges_and_corners(rectangle_of(patch), edges, vertices);
  add_edges_and_corners(travel, edges, vertices);
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) add_crossing(edges[i], edges[j], vertices);

  std::map<std::vector<std::size_t>, Point> sets;
  const auto test = [&](Point place) {
    place.x = std::clamp(place.x, travel.centre.x - travel.half_width, travel.centre.x + travel.half_width);
    place.y = std::clamp(place.y, travel.centre.y - travel.half_height, travel.centre.y + travel.half_height);
    std::vector<std::size_t> acting = stack.acting_at(place.x, place.y);
    if (!acting.empty()) sets.try_emplace(std::move(acting), place);
  };
  for (const Vertex& vertex : vertices)
    for (const double first : {-kBeside_m, kBeside_m})
      for (const double second : {-kBeside_m, kBeside_m})
        test(vertex.place.plus(first, vertex.first).plus(second, vertex.second));
  std::vector<ActingPatches> all;
  for (const auto& [acting, place] : sets) all.push_back({acting, place.x, place.y});
  return all;
}

}  // namespace tacto::playback

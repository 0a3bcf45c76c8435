// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_ghost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "firmware-host/core/scene/piece_texture.hpp"
#include "playback/prepare/scene/contact_transient.hpp"
#include "playback/prepare/scene/volume_block.hpp"
#include "playback/render/reference/exact_relief.hpp"

namespace tacto::playback {

using schema::Piece;
using schema::PieceShape;

namespace {

constexpr double kNear_m = 1e-9;  // nearer, a piece is touched
constexpr double kBends_m = 1e-13;
constexpr double kFarAway_m = 1e3;  // a mesh and a volume, which are asked elsewhere
constexpr int kPasses = 300;        // of a tick
constexpr int kSweeps = 2000;       // of Hildreth's iteration
constexpr int kEntrySamples = 128;  // of a way

double inner(const SpaceMetres& a, const SpaceMetres& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

SpaceMetres sum_of(const SpaceMetres& a, double by, const SpaceMetres& b) {
  return {a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2]};
}

double size_of(const SpaceMetres& a) {
  return std::sqrt(inner(a, a));
}

SpaceMetres unit_of(const std::array<double, 3>& a) {
  return sum_of({}, 1 / size_of(a), a);
}

// As the sum of its straight parts and jumps up to this depth.
double spring_n(const Piece& piece, double depth_m) {
  double force_n = 0;
  schema::TravelPoint last;
  for (const schema::TravelPoint& next : piece.travel) {
    const double part_m = next.depth_m - last.depth_m, rise_n = next.force_n - last.force_n;
    if (depth_m >= last.depth_m || part_m == 0)
      force_n += part_m > 0 ? rise_n * std::clamp((depth_m - last.depth_m) / part_m, 0.0, 1.0)
                            : (depth_m >= next.depth_m ? rise_n : 0);
    last = next;
  }
  return force_n + piece.stiffness_n_per_m * std::max(0.0, depth_m - last.depth_m);
}

}  // namespace

ExactGhost::ExactGhost(const PreparedScene& scene, const schema::Device& device, double rate_hz)
    : scene_(scene),
      device_(device),
      tick_s_(1 / rate_hz),
      walls_(scene.pieces.size()),
      pieces_(scene.pieces) {
  for (const Piece& piece : scene.pieces)
    meshes_.push_back(piece.shape == PieceShape::mesh
                          ? std::optional<ExactMesh>(std::in_place, scene.meshes.at(piece.mesh),
                                                     SpaceMetres{piece.x_m, piece.y_m, piece.z_m})
                          : std::nullopt);
  for (const Piece& piece : scene.pieces)
    if (const schema::Volume* const volume =
            piece.carve ? scene.reliefs.volumes.at(piece.volume).get() : nullptr)
      carved_.push_back(CarvedVolume{*volume, std::ranges::min(volume->stored), 0});
    else
      carved_.emplace_back();
  for (const Piece& piece : scene.pieces)
    if (piece.clay) clay_.emplace(piece.name, scene.reliefs.of(*piece.relief));
}

const Relief& ExactGhost::relief_of(const Piece& piece) const {
  const auto clay = clay_.find(piece.name);
  return clay != clay_.end() ? clay->second : scene_.reliefs.of(*piece.relief);
}

ExactGhost::Surface ExactGhost::surface_at(const Piece& piece, const SpaceMetres& place_m) const {
  const SpaceMetres p = sum_of(place_m, -1, {piece.x_m, piece.y_m, piece.z_m});
  const double radius_m = scene_.point_radius_m;
  if (piece.shape == PieceShape::mesh || piece.shape == PieceShape::volume) return {kFarAway_m, {0, 0, 1}};
  if (piece.shape == PieceShape::plane) {
    const SpaceMetres n = unit_of(piece.direction);
    const double above_m = inner(n, p), below_m = -piece.thickness_m - above_m;
    if (piece.thickness_m > 0 && below_m > above_m) return {below_m - radius_m, sum_of({}, -1, n)};
    if (!schema::is_raised(piece)) return {above_m - radius_m, n};
    const Relief& relief = relief_of(piece);
    const auto [u, v] = relief_axes(piece);
    const SplineValue at =
        spline_of(relief.levels.front(), place_on_level(relief, relief.levels.front(), 0, inner(u, p)),
                  place_on_level(relief, relief.levels.front(), 1, inner(v, p)));
    const SpaceMetres slope = sum_of(sum_of(n, -at.by_x / relief.pitch_m, u), -at.by_y / relief.pitch_m, v);
    return {(above_m - at.value) / size_of(slope), unit_of(slope)};
  }
  if (piece.shape == PieceShape::quadric) {
    const auto& c = piece.coefficients;
    const auto [x, y, z] = p;
    const double value = c[0] * x * x + c[1] * y * y + c[2] * z * z + c[3] * x * y + c[4] * y * z +
                         c[5] * x * z + c[6] * x + c[7] * y + c[8] * z + c[9];
    const SpaceMetres slope = {2 * c[0] * x + c[3] * y + c[5] * z + c[6],
                               2 * c[1] * y + c[3] * x + c[4] * z + c[7],
                               2 * c[2] * z + c[4] * y + c[5] * x + c[8]};
    const double size = size_of(slope), scale = size_of({c[0], c[1], c[2]}) + size_of({c[6], c[7], c[8]});
    return size > 1e-12 * scale ? Surface{value / size, sum_of({}, 1 / size, slope)} : Surface{value, {}};
  }
  SpaceMetres arm = p;
  if (piece.shape == PieceShape::cylinder) {
    const SpaceMetres axis = unit_of(piece.direction);
    arm = sum_of(p, -inner(axis, p), axis);
  }
  const double size = size_of(arm);
  return {size - piece.radius_m - radius_m, size > 0 ? sum_of({}, 1 / size, arm) : SpaceMetres{0, 0, 1}};
}

double ExactGhost::entry_of(const Piece& piece, const SpaceMetres& from_m, const SpaceMetres& way_m) const {
  const auto inside = [&](double part) {
    return surface_at(piece, sum_of(from_m, part, way_m)).distance_m < 0;
  };
  for (int i = 1; i <= kEntrySamples; ++i) {
    if (!inside(static_cast<double>(i) / kEntrySamples)) continue;
    double out = static_cast<double>(i - 1) / kEntrySamples, in = static_cast<double>(i) / kEntrySamples;
    for (int halved = 0; halved < 60; ++halved) {
      const double middle = (out + in) / 2;
      (inside(middle) ? in : out) = middle;
    }
    return out;
  }
  return 2;
}

// As core::is_held_by; one beside a triangle not where another plane is nearly the same.
void ExactGhost::add_triangles(std::vector<Touch>& touches) {
  std::vector<Touch> beside;
  std::erase_if(triangles_, [&](const TouchedTriangle& touched) {
    const auto side =
        meshes_[touched.piece]->side_of(touched.triangle, sum_of(ghost_m_, -1, offset_of(touched.piece)));
    if (side.distance_m > (side.beside ? 1.125 : 1.5) * kExactSkin_m ||
        side.above_m < -0.05 * side.distance_m)
      return true;
    (side.beside ? beside : touches)
        .push_back({touched.piece, {side.distance_m - kExactSkin_m, side.away}, kExactSkin_m, 0});
    return false;
  });
  for (const Touch& each : beside)
    if (std::ranges::none_of(touches, [&](const Touch& other) {
          return other.skin_m > 0 && inner(other.surface.normal, each.surface.normal) > 0.97;
        }))
      touches.push_back(each);
}

// Hildreth 1957: min |way - straight|^2, normal way >= -distance, one plane after the other.
std::vector<ExactGhost::Held> ExactGhost::follow(const SpaceMetres& hand_m) {
  const auto& pieces = pieces_;
  std::vector<Touch> touches;
  std::vector<bool> touched(pieces.size());
  const auto way_with = [&](const SpaceMetres& straight, double skins) {
    SpaceMetres way = straight;
    for (Touch& touch : touches) touch.push_m = 0;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double changed_m = 0;
      for (Touch& touch : touches) {
        const double distance_m = touch.surface.distance_m + (1 - skins) * touch.skin_m;
        const double lack_m = -distance_m - inner(touch.surface.normal, way);
        const double change_m = std::max(-touch.push_m, lack_m);
        touch.push_m += change_m;
        way = sum_of(way, change_m, touch.surface.normal);
        changed_m = std::max(changed_m, std::abs(change_m));
      }
      if (changed_m < 1e-15) break;
    }
    return way;
  };
  SpaceMetres straight = {};
  for (int pass = 0; pass < kPasses; ++pass) {
    straight = sum_of(hand_m, -1, ghost_m_);
    touches.clear();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Surface surface = surface_at(pieces[i], ghost_m_);
      touched[i] = touched[i] || surface.distance_m <= kNear_m;
      if (touched[i]) touches.push_back({i, surface, 0, 0});
    }
    add_triangles(touches);
    const bool in_skin = std::ranges::any_of(touches, [](const Touch& touch) {
      return touch.skin_m > 0 && touch.surface.distance_m < -0.25 * touch.skin_m;
    });
    const SpaceMetres way = way_with(in_skin ? SpaceMetres{} : straight, 1);
    double part = 1;
    std::size_t met = pieces.size();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (touched[i] || meshes_[i] || pieces[i].shape == PieceShape::volume) continue;
      const double entry = entry_of(pieces[i], ghost_m_, way);
      if (entry < part) part = entry, met = i;
    }
    std::optional<TouchedTriangle> triangle;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (!meshes_[i]) continue;
      const auto hit = meshes_[i]->first_hit(sum_of(ghost_m_, -1, offset_of(i)), way);
      if (hit && hit->part <= part) part = hit->part, met = i, triangle = {i, hit->triangle};
    }
    if (triangle)
      triangles_.push_back(*triangle);
    else if (met < pieces.size())
      touched[met] = true;
    // On a surface that bends towards the ghost the whole way may lead back and forth without an end.
    for (const Touch& touch : touches)
      if (met == pieces.size() && touch.skin_m == 0 && touch.push_m > 0 &&
          surface_at(pieces[touch.piece], sum_of(ghost_m_, 1, way)).distance_m < -kBends_m)
        part = std::min(part, 0.5);
    ghost_m_ = sum_of(ghost_m_, part, way);
    if (met == pieces.size() && !in_skin && size_of(way) < (triangles_.empty() ? 1e-13 : 1e-11)) break;
  }
  way_with(straight, 0);
  std::vector<Held> held(pieces.size());
  std::vector<SpaceMetres> push(pieces.size());
  for (const Touch& touch : touches)
    push[touch.piece] = sum_of(push[touch.piece], touch.push_m, touch.surface.normal);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    held[i].normal = surface_at(pieces[i], ghost_m_).normal;
    if (const double depth_m = size_of(push[i]); depth_m > 0)
      held[i] = {sum_of({}, 1 / depth_m, push[i]), depth_m};
  }
  return held;
}

// Of many directions the one with the shortest way, and then by ever smaller turns of it.
ExactGhost::Held ExactGhost::shortest_way_out(const Piece& piece, const SpaceMetres& hand_m) const {
  constexpr int kDirections = 500, kTurns = 4000;
  constexpr double kFar_m = 1e9, kGolden = 2.399963229728653, kLeastTurn = 1e-12;
  const SpaceMetres from = sum_of(hand_m, -1, {piece.x_m, piece.y_m, piece.z_m});
  const auto& c = piece.coefficients;
  const auto second = [&](const SpaceMetres& a, const SpaceMetres& b) {
    return c[0] * a[0] * b[0] + c[1] * a[1] * b[1] + c[2] * a[2] * b[2] +
           (c[3] * (a[0] * b[1] + a[1] * b[0]) + c[4] * (a[1] * b[2] + a[2] * b[1]) +
            c[5] * (a[0] * b[2] + a[2] * b[0])) /
               2;
  };
  const SpaceMetres first = {c[6], c[7], c[8]};
  const auto way_out = [&](const SpaceMetres& u) {
    const double a = second(u, u), b = second(from, u) + inner(first, u) / 2,
                 value = second(from, from) + inner(first, from) + c[9], square = b * b - a * value;
    if (!(square >= 0)) return kFar_m;
    const double end = b >= 0 ? b + std::sqrt(square) : a > 0 ? -a * value / (std::sqrt(square) - b) : 0;
    return end > 0 ? -value / end : kFar_m;
  };
  Held best{{0, 0, 1}, kFar_m};
  const auto take = [&](const SpaceMetres& u) {
    const double way_m = way_out(u);
    if (!(way_m < best.depth_m)) return false;
    best = {u, way_m};
    return true;
  };
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
    take({r * std::cos(kGolden * i), r * std::sin(kGolden * i), z});
  }
  double turn = 0.2;
  for (int i = 0; i < kTurns && turn > kLeastTurn; ++i) {
    bool nearer = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double by : {turn, -turn}) {
        SpaceMetres u = best.normal;
        u[axis] += by;
        nearer = take(unit_of(u)) || nearer;
      }
    if (!nearer) turn /= 2;
  }
  return best.depth_m < kFar_m ? best : Held{best.normal, 0};
}

ExactGhost::Held ExactGhost::nearest_face(const Piece& piece, const SpaceMetres& hand_m) const {
  SpaceMetres at = hand_m;
  Surface surface = surface_at(piece, at);
  if (surface.distance_m >= 0) return {surface.normal, 0};
  if (piece.shape == PieceShape::quadric) return shortest_way_out(piece, hand_m);
  for (int i = 0; i < kPasses; ++i) {
    const double depth_m = -surface.distance_m + inner(surface.normal, sum_of(at, -1, hand_m));
    at = sum_of(hand_m, depth_m, surface.normal);
    surface = surface_at(piece, at);
  }
  return {surface.normal, size_of(sum_of(at, -1, hand_m))};
}

// In closed form, where the kernel goes from tick to tick.
double ExactGhost::transient_n(const Piece& piece, const Wall& wall) const {
  const auto transient = transient_of(piece);
  return transient ? wall.contact_mps * force_at(*transient, wall.ticks * tick_s_) : 0;
}

double ExactGhost::wall_force(const Piece& piece, Wall& wall, const Held& held, double outside_m,
                              double speed_mps) const {
  if (wall.touched) ++wall.ticks;
  if (!(held.depth_m > 0)) {
    if (outside_m > double{core::kLetGo_m}) {
      Wall next;
      next.line = wall.line, next.path_m = wall.path_m;
      next.slid_m = wall.slid_m, next.slid_mps = wall.slid_mps;
      wall = next;
    }
    return 0;
  }
  if (!wall.touched) wall.contact_mps = std::max(0.0, -speed_mps);
  if (!wall.touched) wall.impulse_ns = piece.arrest_mass_kg * wall.contact_mps;
  wall.touched = true;
  if (speed_mps >= 0) wall.impulse_ns = 0;
  double most_n = device_.peak_force_n, grain_m = 0;
  for (const schema::DeviceAxis& axis : device_.axes) {
    const double share = std::abs(held.normal[axis.name == "x" ? 0 : axis.name == "y" ? 1 : 2]);
    if (share > 0) most_n = std::min(most_n, axis.peak_force_n / share);
    grain_m += share * axis.encoder_step_m;
  }
  const double deep_m = held.depth_m > double{core::kIntegralRest} * grain_m ? held.depth_m : 0;
  wall.integral_n +=
      tick_s_ * (piece.integral_n_per_m_s * deep_m - piece.integral_leak_per_s * wall.integral_n);
  wall.integral_n = std::clamp(wall.integral_n, 0.0, piece.integral_bound_n);
  const double own_n = std::max(0.0, spring_n(piece, held.depth_m) - piece.damping_n_s_per_m * speed_mps +
                                         wall.integral_n + transient_n(piece, wall));
  const double given_n = std::clamp(most_n - own_n, 0.0, wall.impulse_ns / tick_s_);
  wall.impulse_ns -= given_n * tick_s_;
  return own_n + given_n;
}

SpaceMetres ExactGhost::friction_force(const Piece& piece, Wall& wall, double normal_n,
                                       const SpaceMetres& normal, const SpaceMetres& place_m,
                                       const SpaceMetres& speed_mps) const {
  constexpr int kSlips = 100'000, kHalvings = 60;
  const auto along = [&](const SpaceMetres& v) { return sum_of(v, -inner(v, normal), normal); };
  const SpaceMetres last_m = std::exchange(wall.last_m, place_m);
  const SpaceMetres viscous_n = sum_of({}, normal_n > 0 ? -piece.viscous_n_s_per_m : 0, along(speed_mps));
  const double by_m = piece.stiffness_n_per_m > 0 ? normal_n / piece.stiffness_n_per_m : 0;
  const double holds_m = piece.static_friction * by_m, slipped_m = piece.kinetic_friction * by_m;
  if (!(holds_m > 0)) wall.anchor_m = place_m;
  SpaceMetres stretch = along(sum_of(place_m, -1, wall.anchor_m));
  if (size_of(stretch) > holds_m) {
    stretch = along(sum_of(last_m, -1, wall.anchor_m));
    SpaceMetres way = along(sum_of(place_m, -1, last_m));
    const auto shorten_to = [&](double to_m) {
      if (const double size = size_of(stretch); size > to_m) stretch = sum_of({}, to_m / size, stretch);
    };
    if (size_of(stretch) > holds_m) shorten_to(slipped_m);
    for (int i = 0; i < kSlips && slipped_m < holds_m; ++i) {
      if (!(size_of(sum_of(stretch, 1, way)) > holds_m)) break;
      double before = 0, after = 1;
      for (int half = 0; half < kHalvings; ++half) {
        const double middle = (before + after) / 2;
        (size_of(sum_of(stretch, middle, way)) > holds_m ? after : before) = middle;
      }
      stretch = sum_of(stretch, after, way);
      way = sum_of({}, 1 - after, way);
      shorten_to(slipped_m);
    }
    stretch = sum_of(stretch, 1, way);
    shorten_to(holds_m);
    wall.anchor_m = sum_of(place_m, -1, stretch);
  }
  return sum_of(viscous_n, -piece.stiffness_n_per_m, stretch);
}

SpaceMetres ExactGhost::texture_force(const Piece& piece, Wall& wall, double& normal_n,
                                      const SpaceMetres& normal, const SpaceMetres& place_m,
                                      const SpaceMetres& speed_mps) const {
  if (!piece.texture || !(normal_n > 0)) return {};
  const auto along = [&](const SpaceMetres& v) { return sum_of(v, -inner(v, normal), normal); };
  if (piece.texture->type != schema::PieceTextureType::recording) {
    const auto [u, v] = schema::map_axes(piece.texture->axes);
    const SpaceMetres at_m = sum_of(place_m, -1, {piece.x_m, piece.y_m, piece.z_m}),
                      passed_mps = along(speed_mps);
    if (piece.texture->type == schema::PieceTextureType::sine) {
      const auto [p, q] = piece.texture->periods_m;
      const double a_n = piece.texture_gain * piece.texture->amplitude_n, turn = 2 * std::numbers::pi;
      const double cycles =
          (std::abs(inner(u, passed_mps)) / p + std::abs(inner(v, passed_mps)) / q) * tick_s_;
      const double share =
          std::sin(turn * inner(u, at_m) / p) * std::sin(turn * inner(v, at_m) / q) * played_share(cycles);
      normal_n += share * std::copysign(std::min(std::abs(a_n), normal_n), a_n);
      return {};
    }
    const auto slope = exact_slope(scene_.reliefs.of(*piece.texture), inner(u, at_m), inner(v, at_m),
                                   std::hypot(inner(u, passed_mps), inner(v, passed_mps)), 1 / tick_s_);
    const SpaceMetres tilt = sum_of({}, -piece.texture_gain,
                                    along(sum_of(sum_of({}, slope.along_columns, u), slope.along_rows, v)));
    if (piece.texture->type == schema::PieceTextureType::normals) normal_n /= std::hypot(1, size_of(tilt));
    return sum_of({}, normal_n, tilt);
  }
  const SpaceMetres way = along(sum_of(place_m, -1, wall.last_m)), before = along(wall.line);
  const double by = (inner(way, before) < 0 ? -1 : 1) / double{core::kPathLine_m};
  const SpaceMetres turned = sum_of(before, by, way);
  if (!(size_of(turned) > 0)) return {};
  wall.line = unit_of(turned);
  wall.path_m += inner(way, wall.line);
  const Relief& relief = scene_.reliefs.of(*piece.texture);
  // From the first end of the texture forth to the other one, and back.
  const double length_m = static_cast<double>(relief.columns) * relief.pitch_m;
  const double turns = wall.path_m / (2 * length_m), part = turns - std::floor(turns);
  const double from_first_m = 2 * length_m * std::min(part, 1 - part);
  const double slope =
      exact_slope(relief, from_first_m - length_m / 2, 0, std::abs(inner(speed_mps, wall.line)), 1 / tick_s_)
          .along_columns;
  return sum_of({}, piece.texture_gain * slope, wall.line);
}

SpaceMetres ExactGhost::offset_of(std::size_t piece) const {
  const auto& slide = scene_.pieces[piece].slide;
  return slide ? sum_of({}, walls_[piece].slid_m, unit_of(slide->direction)) : SpaceMetres{};
}

// The contract of core::push_slide, and of the ghost that a piece takes along.
void ExactGhost::move_slide(std::size_t piece, double push_n) {
  const schema::PieceSlide& slide = *scene_.pieces[piece].slide;
  Wall& wall = walls_[piece];
  const double by_force = tick_s_ / slide.mass_kg, kept = 1 / (1 + by_force * slide.viscous_n_s_per_m);
  const double turn = slide.detent_m > 0 ? 2 * std::numbers::pi * wall.slid_m / slide.detent_m : 0;
  const double speed = kept * (wall.slid_mps + by_force * (push_n - slide.detent_n * std::sin(turn)));
  wall.slid_mps = std::copysign(std::max(0.0, std::abs(speed) - kept * by_force * slide.friction_n), speed);
  const double end_m = wall.slid_m + tick_s_ * wall.slid_mps,
               way_m = std::clamp(end_m, slide.from_m, slide.to_m) - wall.slid_m;
  if (end_m < slide.from_m || end_m > slide.to_m) wall.slid_mps = 0;
  const SpaceMetres way = sum_of({}, way_m, unit_of(slide.direction));
  const auto meets = [&](std::size_t i, const SpaceMetres& along) {
    if (!meshes_[i]) return entry_of(pieces_[i], ghost_m_, along);
    const auto hit = meshes_[i]->first_hit(sum_of(ghost_m_, -1, offset_of(i)), along);
    return hit ? hit->part : 2;
  };
  double own = 1, free = 1;
  if (scene_.contact == schema::PieceContact::ghost && way_m != 0)
    own = std::min(1.0, meets(piece, sum_of({}, -1, way)));
  const SpaceMetres carried = sum_of({}, 1 - own, way);
  for (std::size_t i = 0; i < pieces_.size() && own < 1; ++i) {
    if (i == piece) continue;
    const Surface at = surface_at(pieces_[i], ghost_m_);
    const bool touches = !meshes_[i] && at.distance_m <= kNear_m;
    if (!touches)
      free = std::min(free, meets(i, carried));
    else if (inner(at.normal, carried) < -1e-3 * size_of(carried))
      free = 0;
  }
  ghost_m_ = sum_of(ghost_m_, free, carried);
  if (free < 1) wall.slid_mps = 0;
  wall.slid_m += way_m * (own + free * (1 - own));
  const SpaceMetres offset = offset_of(piece);
  const Piece& begin = scene_.pieces[piece];
  pieces_[piece].x_m = begin.x_m + offset[0], pieces_[piece].y_m = begin.y_m + offset[1];
  pieces_[piece].z_m = begin.z_m + offset[2];
}

// As core::touch_volume.
ExactGhost::Held ExactGhost::in_volume(std::size_t index, const SpaceMetres& hand_m, double& outside_m) {
  const Piece& piece = scene_.pieces[index];
  const schema::Volume& volume =
      carved_[index] ? carved_[index]->volume : *scene_.reliefs.volumes.at(piece.volume);
  const SpaceMetres from_middle_m = sum_of(hand_m, -1, {piece.x_m, piece.y_m, piece.z_m});
  const std::vector<SpaceMetres> hand_alone(1);
  SpaceMetres sum_m = {};
  std::optional<double> fall;
  for (const SpaceMetres& point_m : scene_.tool_m.empty() ? hand_alone : scene_.tool_m) {
    const SpaceMetres place_m = sum_of(from_middle_m, 1, point_m);
    schema::VolumeValue at;
    if (!value_at(volume, place_m, at)) continue;
    const double depth_m = (at.value - piece.iso) / piece.value_per_m;
    outside_m = std::min(outside_m, std::max(0.0, -depth_m));
    const SpaceMetres push_m = sum_of({}, -std::max(0.0, depth_m) / piece.value_per_m, at.slope_per_m);
    sum_m = sum_of(sum_m, 1, push_m);
    if (!carved_[index] || !(piece.stiffness_n_per_m * size_of(push_m) > piece.carve->force_n)) continue;
    if (!fall) fall = fall_of_tick(index);
    carve(index, place_m, *fall);
  }
  const double size_m = size_of(sum_m);
  return size_m > 0 ? Held{sum_of({}, 1 / size_m, sum_m), size_m} : Held{{0, 0, 1}, 0};
}

double ExactGhost::fall_of_tick(std::size_t index) {
  auto& [volume, lowest, uncut] = *carved_[index];
  uncut += carve_per_tick(scene_.pieces[index], volume, 1 / tick_s_) / 0x1p16;
  const double fall = std::floor(uncut);
  uncut -= fall;
  return fall;
}

void ExactGhost::carve(std::size_t index, const SpaceMetres& place_m, double fall) {
  auto& [volume, lowest, uncut] = *carved_[index];
  std::array<std::size_t, 3> first;
  for (std::size_t i = 0; i < 3; ++i)
    first[i] = static_cast<std::size_t>((place_m[i] + volume.half_size_m()[i]) / volume.spacing_m[i]);
  for (std::size_t z = first[2]; z < first[2] + 2; ++z)
    for (std::size_t y = first[1]; y < first[1] + 2; ++y)
      for (std::size_t x = first[0]; x < first[0] + 2; ++x) {
        std::int16_t& value = volume.stored[volume.at(x, y, z)];
        value = static_cast<std::int16_t>(std::max<double>(lowest, value - fall));
      }
}

// As core::press_clay, in double precision: the share of each grid point by its distance from the middle of
// the cell, and of the 16 points that may rise those to which it is the nearest.
void ExactGhost::press_clay(const Piece& piece, const SpaceMetres& place_m) {
  Relief& relief = clay_.at(piece.name);
  ReliefLevel& level = relief.levels.front();
  const auto axes = relief_axes(piece);
  const SpaceMetres p = sum_of(place_m, -1, {piece.x_m, piece.y_m, piece.z_m});
  double middle[2];
  for (int i = 0; i < 2; ++i)
    middle[i] =
        std::floor(place_on_level(relief, level, i, inner(axes[static_cast<std::size_t>(i)], p))) + 0.5;
  const auto height = [&](double column, double row) -> float* {
    const bool there = column >= 0 && row >= 0 && column < static_cast<double>(level.columns) &&
                       row < static_cast<double>(level.rows);
    return there ? &level.coefficients[static_cast<std::size_t>(row) * level.columns +
                                       static_cast<std::size_t>(column)]
                 : nullptr;
  };
  if (height(middle[0] - 0.5, middle[1] - 0.5) == nullptr ||
      height(middle[0] + 0.5, middle[1] + 0.5) == nullptr)
    return;
  struct Point {
    double x, y, r2;
  };
  std::vector<Point> points;
  for (double y = -2.5; y < 3; ++y)
    for (double x = -2.5; x < 3; ++x) points.push_back({x, y, x * x + y * y});
  const schema::Clay& clay = *piece.clay;
  for (const Point& point : points) {
    if (point.r2 > 3) continue;
    const double of = point.r2 < 1 ? 8.5 : 6.5, sinks_m = clay.half_m * (point.r2 < 1 ? 2 : 1);
    float* const lower = height(middle[0] + point.x, middle[1] + point.y);
    bool moves = lower != nullptr && *lower - sinks_m >= clay.least_m;
    std::vector<float*> higher;
    for (const Point& to : points) {
      const bool gets = std::hypot(to.x - point.x, to.y - point.y) < (point.r2 < 1 ? 2.5 : 1.1);
      if (!clay.kept || to.r2 != of || !gets) continue;
      higher.push_back(height(middle[0] + to.x, middle[1] + to.y));
      moves = moves && higher.back() != nullptr && *higher.back() + clay.half_m <= clay.most_m;
    }
    if (!moves) continue;
    *lower = static_cast<float>(*lower - sinks_m);
    for (float* const each : higher) *each = static_cast<float>(*each + clay.half_m);
  }
}

SpaceMetres ExactGhost::force(const SpaceMetres& hand_m, const SpaceMetres& speed_mps) {
  const bool arrives = !placed_;
  if (arrives) ghost_m_ = hand_m;
  placed_ = true;
  const bool adds = scene_.contact == schema::PieceContact::add;
  std::vector<Held> held(scene_.pieces.size());
  if (!adds) held = follow(hand_m);
  SpaceMetres sum = {};
  std::vector<double> push_n(scene_.pieces.size());
  for (std::size_t i = 0; i < scene_.pieces.size(); ++i) {
    const Piece& piece = pieces_[i];
    if (adds) held[i] = nearest_face(piece, hand_m);
    double outside_m = surface_at(piece, hand_m).distance_m;
    const SpaceMetres offset = offset_of(i);
    if (meshes_[i] && walls_[i].touched) outside_m = meshes_[i]->distance_m(sum_of(hand_m, -1, offset));
    const bool is_volume = piece.shape == PieceShape::volume;
    if (is_volume) held[i] = in_volume(i, hand_m, outside_m);
    SpaceMetres relative_mps = speed_mps;
    if (piece.slide) relative_mps = sum_of(speed_mps, -walls_[i].slid_mps, unit_of(piece.slide->direction));
    double force_n = wall_force(piece, walls_[i], held[i], outside_m, inner(held[i].normal, relative_mps));
    const SpaceMetres touched_m = is_volume ? hand_m
                                  : adds    ? sum_of(hand_m, held[i].depth_m, held[i].normal)
                                            : ghost_m_;
    const SpaceMetres on = sum_of(touched_m, -1, offset);
    if (arrives) walls_[i].anchor_m = walls_[i].last_m = on;
    SpaceMetres own = texture_force(scene_.pieces[i], walls_[i], force_n, held[i].normal, on, relative_mps);
    own = sum_of(own, force_n, held[i].normal);
    own = sum_of(own, 1, friction_force(piece, walls_[i], force_n, held[i].normal, on, relative_mps));
    sum = sum_of(sum, 1, own);
    if (piece.clay && spring_n(piece, held[i].depth_m) > piece.clay->force_n)
      press_clay(scene_.pieces[i], on);
    if (piece.slide) push_n[i] = -inner(own, unit_of(piece.slide->direction));
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    if (pieces_[i].slide) move_slide(i, push_n[i]);
  return sum;
}

}  // namespace tacto::playback

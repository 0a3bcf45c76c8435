// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/judged_piece.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "playback/stability/sampled_loop.hpp"

namespace tacto::playback {
namespace {

using schema::Piece;
using schema::PieceShape;
using schema::Scene;
using Vector3 = std::array<double, 3>;

constexpr double kSameDirection = 1e-9;  // of cosines

double dot_of(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3 normal_of(const Piece& plane) {
  const double size = std::sqrt(dot_of(plane.direction, plane.direction));
  return {plane.direction[0] / size, plane.direction[1] / size, plane.direction[2] / size};
}

Vector3 place_of(const Piece& piece) {
  return {piece.x_m, piece.y_m, piece.z_m};
}

// Of the surface of a plane along its normal.
double height_m(const Piece& plane, double point_radius_m) {
  return dot_of(normal_of(plane), place_of(plane)) + point_radius_m;
}

enum class Meeting {
  none,    // at no place
  across,  // planes at a right angle
  summed,  // planes of the same direction
  other
};

bool is_half_space(const Piece& piece) {
  return piece.shape == PieceShape::plane && !(piece.thickness_m > 0);
}

Meeting meeting_of_planes(const Piece& a, const Piece& b, double radius_m) {
  const double cosine = dot_of(normal_of(a), normal_of(b));
  if (std::abs(cosine) < kSameDirection) return Meeting::across;
  if (!is_half_space(a) || !is_half_space(b)) return Meeting::other;
  const bool apart = height_m(a, radius_m) + height_m(b, radius_m) <= 0;
  if (cosine < kSameDirection - 1) return apart ? Meeting::none : Meeting::other;
  const bool one_leak = a.integral_leak_per_s == b.integral_leak_per_s || !(a.integral_n_per_m_s > 0) ||
                        !(b.integral_n_per_m_s > 0);
  return cosine > 1 - kSameDirection && one_leak ? Meeting::summed : Meeting::other;
}

Meeting meeting_of(const Piece& a, const Piece& b, double radius_m) {
  if (schema::is_raised(a) || schema::is_raised(b)) return Meeting::other;
  if (a.shape == PieceShape::plane && b.shape == PieceShape::plane) return meeting_of_planes(a, b, radius_m);
  if (b.shape == PieceShape::plane) return meeting_of(b, a, radius_m);
  if (b.shape != PieceShape::sphere) return Meeting::other;
  const Vector3 centre = place_of(b);
  double distance_m = 0;
  if (is_half_space(a))
    distance_m = dot_of(normal_of(a), centre) - height_m(a, radius_m);
  else if (a.shape == PieceShape::sphere)
    distance_m = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m) - a.radius_m - radius_m;
  else
    return Meeting::other;
  return distance_m >= b.radius_m + radius_m ? Meeting::none : Meeting::other;
}

struct OnDevice {
  const schema::Device& device;
  double rate_hz;
  const std::optional<schema::Hand>& hand;

  double growth(const Piece& piece) const { return wall_growth(piece, device, rate_hz, hand); }
};

void add_wall(Piece& sum, const Piece& other) {
  sum.stiffness_n_per_m += other.stiffness_n_per_m;
  sum.damping_n_s_per_m += other.damping_n_s_per_m;
  if (other.integral_n_per_m_s > 0) sum.integral_leak_per_s = other.integral_leak_per_s;
  sum.integral_n_per_m_s += other.integral_n_per_m_s;
}

bool rubs(const Piece& piece) {
  return piece.static_friction > 0 || piece.viscous_n_s_per_m > 0 ||
         (piece.texture && piece.texture->type != schema::PieceTextureType::sine && piece.texture_gain != 0);
}

// Along its surface: the spring and the damper of a friction that holds, and the slope of the texture's
// force.
Piece friction_of(const Piece& piece, const OnDevice& on) {
  Piece along = piece;
  if (!(piece.static_friction > 0)) along.stiffness_n_per_m = 0;
  along.stiffness_n_per_m += texture_stiffness_n_per_m(piece, on.device);
  along.damping_n_s_per_m = piece.viscous_n_s_per_m;
  along.integral_n_per_m_s = 0;
  return along;
}

void try_along(JudgedPiece& worst, const Piece& load, const std::vector<std::string>& with,
               const OnDevice& on) {
  const double growth = on.growth(load);
  if (growth < worst.growth_along) return;
  worst.growth_along = growth, worst.along = load, worst.along_with = with;
}

// A plane at a right angle: along the edge of both the frictions add up. Along the normal of the other one
// its wall, with this friction; of a ghost with its damper only, because the ghost does not move there.
void try_across(JudgedPiece& worst, const Piece& friction, const Piece& other, std::vector<std::string> with,
                bool adds, const OnDevice& on) {
  with.push_back(other.name);
  if (rubs(other)) {
    Piece edge = friction;
    add_wall(edge, friction_of(other, on));
    try_along(worst, edge, with, on);
  }
  const Piece alone = steepest_wall(other);
  Piece wall = alone;
  add_wall(wall, friction);
  if (!adds) wall.stiffness_n_per_m = alone.stiffness_n_per_m;
  if (adds || friction.damping_n_s_per_m > 0) try_along(worst, wall, with, on);
}

JudgedPiece judged_at(const Scene& scene, std::size_t index, const OnDevice& on) {
  const Piece& piece = scene.pieces[index];
  const bool adds = scene.contact == schema::PieceContact::add;
  std::vector<const Piece*> same, across;
  std::vector<std::string> unjudged;
  Piece damped = steepest_wall(piece), held = friction_of(piece, on);
  for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
    if (i == index) continue;
    const Piece& other = scene.pieces[i];
    const Meeting meeting = meeting_of(piece, other, scene.point_radius_m);
    if (meeting == Meeting::summed && adds) same.push_back(&other);
    if (meeting == Meeting::across) across.push_back(&other);
    if (meeting != Meeting::other) continue;
    unjudged.push_back(other.name);
    damped.damping_n_s_per_m += steepest_wall(other).damping_n_s_per_m + other.viscous_n_s_per_m;
    add_wall(held, friction_of(other, on));
  }
  std::vector<const Piece*> depths = same;
  depths.push_back(&piece);
  JudgedPiece worst;
  worst.alone = piece;
  for (const Piece* lowest : depths) {
    if (height_m(*lowest, 0) > height_m(piece, 0)) continue;  // there the hand is above the piece
    // With those of the same direction that touch a hand which is as deep as the surface of `lowest`.
    Piece total = steepest_wall(piece), friction = friction_of(piece, on);
    std::vector<std::string> with;
    for (const Piece* other : same) {
      if (height_m(*other, 0) < height_m(*lowest, 0)) continue;
      add_wall(total, steepest_wall(*other));
      add_wall(friction, friction_of(*other, on));
      with.push_back(other->name);
    }
    if (rubs(piece)) {
      try_along(worst, friction, with, on);
      for (const Piece* other : across) try_across(worst, friction, *other, with, adds, on);
    }
    const double growth = on.growth(total);
    if (growth < worst.growth) continue;
    worst.growth = growth, worst.total = std::move(total), worst.with = std::move(with);
  }
  const bool may_grow = adds || on.growth(damped) > 1 || (rubs(piece) && on.growth(held) > 1);
  if (!worst.is_unstable() && !unjudged.empty() && may_grow) worst.unjudged = std::move(unjudged);
  return worst;
}

}  // namespace

Piece steepest_wall(const Piece& piece) {
  Piece steepest = piece;
  steepest.stiffness_n_per_m = steepest_spring_n_per_m(piece);
  if (!piece.texture || piece.texture->type != schema::PieceTextureType::sine || piece.texture_gain == 0)
    return steepest;
  steepest.stiffness_n_per_m *= 2, steepest.damping_n_s_per_m *= 2, steepest.integral_n_per_m_s *= 2;
  return steepest;
}

double texture_stiffness_n_per_m(const Piece& piece, const schema::Device& device) {
  if (!piece.texture || piece.texture->type == schema::PieceTextureType::sine) return 0;
  const double gain = std::abs(piece.texture_gain);
  if (piece.texture->type == schema::PieceTextureType::recording) return gain * piece.texture->steepest;
  const bool round = piece.shape == PieceShape::sphere || piece.shape == PieceShape::cylinder;
  return gain * device.peak_force_n *
         (piece.texture->steepest + (round ? piece.texture->largest / piece.radius_m : 0));
}

double most_energy_j(const Piece& piece, const schema::Device& device) {
  if (!piece.texture || piece.texture->type != schema::PieceTextureType::normals) return 0;
  const double most_n = device.peak_force_n, held = 1 - 1 / std::hypot(1, piece.texture->largest);
  const double stored_j = most_n * most_n / (2 * piece.stiffness_n_per_m);
  return most_n * piece.relief->range_m + (piece.stiffness_n_per_m > 0 ? held * stored_j : 0);
}

double wall_growth(const Piece& piece, const schema::Device& device, double rate_hz,
                   const std::optional<schema::Hand>& hand) {
  const schema::Hand held = hand.value_or(schema::Hand());
  std::vector<SampledLoad> loads = {{piece.stiffness_n_per_m,
                                     piece.damping_n_s_per_m,
                                     {},
                                     piece.integral_n_per_m_s,
                                     piece.integral_leak_per_s}};
  if (piece.slide)
    loads.push_back({0,
                     0,
                     {{piece.slide->mass_kg, piece.slide->viscous_n_s_per_m, piece.stiffness_n_per_m,
                       piece.damping_n_s_per_m, false, true}}});
  double most = 0;
  for (const schema::DeviceAxis& axis : device.axes)
    for (const SampledLoad& load : loads)
      if (axis.mass_kg > 0)
        most = std::max(
            most, growth_per_tick({axis.mass_kg + held.mass_kg,
                                   axis.viscous_n_s_per_m + held.damping_n_s_per_m, held.stiffness_n_per_m},
                                  {1 / rate_hz, device.delay_s * rate_hz}, load));
  return most;
}

// The least stiffness only where there is an integral: without one it is never the worse end.
JudgedPiece judged_piece(const Scene& scene, std::size_t index, const schema::Device& device, double rate_hz,
                         const std::optional<schema::Hand>& hand) {
  const bool grows =
      std::ranges::any_of(scene.pieces, [](const Piece& piece) { return piece.integral_n_per_m_s > 0; });
  const auto rank = [](const JudgedPiece& judged) {
    return std::tuple(judged.is_unstable(), !judged.unjudged.empty(),
                      std::max(judged.growth, judged.growth_along));
  };
  JudgedPiece worst;
  for (std::size_t end = 0; end < (grows ? 4U : 2U); ++end) {
    Scene at = scene;
    for (Piece& piece : at.pieces) {
      const auto ends = slider_ends(piece);
      piece = ends[std::min(end, ends.size() - 1)];
    }
    JudgedPiece judged = judged_at(at, index, {device, rate_hz, hand});
    if (end == 0 || rank(judged) >= rank(worst)) worst = std::move(judged);
  }
  return worst;
}

}  // namespace tacto::playback

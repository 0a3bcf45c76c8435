// SPDX-License-Identifier: GPL-3.0-or-later
// What the schema cannot check of pieces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "data-schema/scene/scene.hpp"

namespace tacto::schema {
namespace {

// Eigenvalues of a symmetric matrix of four rows, by Jacobi's rotations.
std::array<double, 4> eigenvalues_of(std::array<std::array<double, 4>, 4> a) {
  constexpr int kSweeps = 30;  // five are usual
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t p = 0; p < 4; ++p)
      for (std::size_t q = p + 1; q < 4; ++q) {
        if (a[p][q] == 0) continue;
        const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]), c = std::cos(angle),
                     s = std::sin(angle);
        for (std::size_t k = 0; k < 4; ++k) {
          const double left = a[k][p], right = a[k][q];
          a[k][p] = c * left - s * right, a[k][q] = s * left + c * right;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const double up = a[p][k], down = a[q][k];
          a[p][k] = c * up - s * down, a[q][k] = s * up + c * down;
        }
      }
  return {a[0][0], a[1][1], a[2][2], a[3][3]};
}

// Of the terms as a form of x, y, z and 1: a point below 0 exists if and only if it has an eigenvalue below 0
// (a direction of the form without a share of 1 is the limit of points), and so above 0.
Result<void> check_quadric(const Piece& piece, const std::string& where) {
  const auto& c = piece.coefficients;
  const std::array<double, 4> all = eigenvalues_of({{{c[0], c[3] / 2, c[5] / 2, c[6] / 2},
                                                     {c[3] / 2, c[1], c[4] / 2, c[7] / 2},
                                                     {c[5] / 2, c[4] / 2, c[2], c[8] / 2},
                                                     {c[6] / 2, c[7] / 2, c[8] / 2, c[9]}}});
  const auto [least, most] = std::ranges::minmax(all);
  const double rounding = 1e-12 * std::max(-least, most);
  if (least < -rounding && most > rounding) return {};
  const bool no_solid = least >= -rounding;
  return fail(
      ErrorKind::unsuitable,
      no_solid ? "the quadric is empty: the sum of its terms is below 0 at no place"
               : "the quadric fills the whole space: the sum of its terms is above 0 at no place",
      where + "/coefficients",
      "a solid is where the sum is below 0: the unit sphere is [1, 1, 1, 0, 0, 0, 0, 0, 0, -1], in metres");
}

// Of a map, whose shadow along the normal of a plane has to have an area.
Result<void> check_axes(const Piece& piece, const std::array<std::array<double, 3>, 2>& axes, bool projected,
                        const std::string& where) {
  const auto& [u, v] = axes;
  const std::array<double, 3> across = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                        u[0] * v[1] - u[1] * v[0]};
  const double area = std::hypot(across[0], across[1], across[2]),
               sides = std::hypot(u[0], u[1], u[2]) * std::hypot(v[0], v[1], v[2]);
  if (!(sides > 1e-9) || !(area > 1e-6 * sides))
    return fail(ErrorKind::unsuitable, "the two axes have the same direction, or no length", where,
                "give two directions, as in [[1, 0, 0], [0, 1, 0]]");
  const auto& d = piece.direction;
  const double along_normal = std::abs(across[0] * d[0] + across[1] * d[1] + across[2] * d[2]);
  if (projected && !(along_normal > 1e-3 * area * std::hypot(d[0], d[1], d[2])))
    return fail(ErrorKind::unsuitable, "the map is projected along the plane, and not on it", where,
                "give two directions in the plane");
  return {};
}

Result<void> check_relief(const Piece& piece, const std::string& where) {
  if (piece.texture && piece.relief->interpolated)
    return fail(ErrorKind::unsuitable, "a plane with interpolated normals has no texture", where + "/normals",
                "leave `texture` or \"normals\": \"interpolated\" out");
  if (piece.thickness_m > 0)
    return fail(ErrorKind::unsuitable, "a plate has no relief", where,
                "leave thickness_m out: what is below the relief is solid");
  return check_axes(piece, piece.relief->axes, true, where + "/axes");
}

Result<void> check_slide(const PieceSlide& slide, const std::string& where) {
  const auto& d = slide.direction;
  if (!(std::hypot(d[0], d[1], d[2]) > 1e-9))
    return fail(ErrorKind::unsuitable, "a direction of length 0", where + "/direction",
                "give a vector of any length, as in [1, 0, 0]");
  if (!(slide.from_m < slide.to_m))
    return fail(ErrorKind::unsuitable, "the piece cannot move: its two stops are at one place",
                where + "/to_m", "give stops below and above its place: from_m at most 0, to_m at least 0");
  if ((slide.detent_n > 0) != (slide.detent_m > 0))
    return fail(ErrorKind::unsuitable, "detents have a force and a distance",
                where + (slide.detent_n > 0 ? "/detent_n" : "/detent_m"),
                "give both detent_n and detent_m, or neither");
  return {};
}

Result<void> check_piece_texture(const Piece& piece, const std::string& texture_where) {
  const bool sine = piece.texture->type == PieceTextureType::sine;
  const auto needless = [&](const char* member, const char* types) {
    return fail(ErrorKind::unsuitable,
                fmt::format("{} of a texture of the type {}", member, to_string(piece.texture->type)),
                fmt::format("{}/{}", texture_where, member), fmt::format("it belongs to: {}", types));
  };
  if (sine && !piece.texture->file.empty()) return needless("file", "recording, bump");
  if (!sine && piece.texture->amplitude_n > 0) return needless("amplitude_n", "sine");
  if (!sine && piece.texture->periods_m[0] > 0) return needless("periods_m", "sine");
  const std::string where = texture_where + "/axes";
  if (piece.texture->type == PieceTextureType::recording && piece.texture->axes != PieceTexture().axes)
    return fail(ErrorKind::unsuitable, "a recording is played along the path, not along axes", where,
                "leave the axes out");
  return check_axes(piece, piece.texture->axes,
                    piece.texture->type != PieceTextureType::recording && piece.shape == PieceShape::plane,
                    where);
}

// An integral would press itself through a click, and a force that jumps up with the depth holds nothing.
Result<void> check_travel(const Piece& piece, const std::string& where) {
  if (!piece.travel.empty() && piece.integral_n_per_m_s > 0)
    return fail(ErrorKind::unsuitable, "a piece with a travel has no integral", where,
                "leave out `travel` or integral_n_per_m_s");
  TravelPoint last;
  for (std::size_t i = 0; i < piece.travel.size(); ++i) {
    const TravelPoint& point = piece.travel[i];
    if (point.depth_m < last.depth_m)
      return fail(ErrorKind::unsuitable,
                  fmt::format("the depth {:g} m is behind {:g} m", point.depth_m, last.depth_m),
                  fmt::format("{}/{}/depth_m", where, i), "give the points in the order of their depths");
    if (point.depth_m == last.depth_m && point.force_n > last.force_n)
      return fail(ErrorKind::unsuitable,
                  fmt::format("the force jumps up from {:g} to {:g} N at {:g} m: a hand finds no rest there",
                              last.force_n, point.force_n, point.depth_m),
                  fmt::format("{}/{}/force_n", where, i), "let the force rise over a depth, or jump down");
    last = point;
  }
  return {};
}

Result<void> check_volume_members(const Piece& piece, const std::string& where) {
  const bool is_volume = piece.shape == PieceShape::volume;
  const std::pair<const char*, bool> members[] = {{"volume", !piece.volume.empty()},
                                                  {"iso", piece.iso != 0},
                                                  {"value_per_m", piece.value_per_m != 0},
                                                  {"carve", piece.carve.has_value()}};
  for (const auto& [member, given] : members)
    if (given && !is_volume)
      return fail(ErrorKind::unsuitable, fmt::format("a {} has no {}", to_string(piece.shape), member),
                  fmt::format("{}/{}", where, member), "it belongs to: volume");
  if (!is_volume) return {};
  for (const auto& [member, given] :
       {std::pair{"travel", !piece.travel.empty()}, std::pair{"texture", piece.texture.has_value()},
        std::pair{"slide", piece.slide.has_value()}})
    if (given)
      return fail(ErrorKind::unsuitable, fmt::format("a volume has no {}", member),
                  fmt::format("{}/{}", where, member), "leave it out");
  return {};
}

Result<void> check_members(const Piece& piece, const std::string& where) {
  const bool round = piece.shape == PieceShape::sphere || piece.shape == PieceShape::cylinder;
  const auto refused = [&](const char* member, const char* shapes) {
    return fail(ErrorKind::unsuitable, fmt::format("a {} has no {}", to_string(piece.shape), member),
                fmt::format("{}/{}", where, member), fmt::format("it belongs to: {}", shapes));
  };
  if (piece.radius_m != 0 && !round) return refused("radius_m", "sphere, cylinder");
  if (piece.thickness_m != 0 && piece.shape != PieceShape::plane) return refused("thickness_m", "plane");
  const bool directed = piece.shape == PieceShape::plane || piece.shape == PieceShape::cylinder;
  if (!directed && piece.direction != Piece().direction) return refused("direction", "plane, cylinder");
  if (piece.coefficients != Piece().coefficients && piece.shape != PieceShape::quadric)
    return refused("coefficients", "quadric");
  if (!piece.mesh.empty() && piece.shape != PieceShape::mesh) return refused("mesh", "mesh");
  if (piece.relief && piece.shape != PieceShape::plane) return refused("relief", "plane");
  if (piece.clay && !is_raised(piece))
    return fail(ErrorKind::unsuitable, "clay is a plane with a relief of exact normals", where + "/clay",
                piece.relief ? "leave \"normals\": \"interpolated\" out"
                             : "give `relief` with a height map; one of equal heights is a flat block");
  TACTO_TRY(check_volume_members(piece, where));
  const auto& d = piece.direction;
  if (!(std::hypot(d[0], d[1], d[2]) > 1e-9))
    return fail(ErrorKind::unsuitable, "a direction of length 0", where + "/direction",
                "give a vector of any length, as in [0, 0, 1]");
  if (piece.integral_n_per_m_s > 0 && !(piece.integral_bound_n > 0))
    return fail(ErrorKind::unsuitable, "an integral without a bound grows without an end",
                where + "/integral_n_per_m_s", "give integral_bound_n, the largest force of the integral");
  for (const auto& [member, value] : {std::pair{"integral_bound_n", piece.integral_bound_n},
                                      std::pair{"integral_leak_per_s", piece.integral_leak_per_s}})
    if (value > 0 && !(piece.integral_n_per_m_s > 0))
      return fail(ErrorKind::unsuitable, fmt::format("{} of a piece without an integral", member),
                  fmt::format("{}/{}", where, member), "give integral_n_per_m_s too, or leave it out");
  for (const PieceNumber& number : kWallNumbers) TACTO_TRY(check_slider(named_number(piece, number), where));
  const auto slider_of = [&](const char* name, double value) {
    const auto at = piece.sliders.find(name);
    return at == piece.sliders.end() ? SliderRange{value, value} : at->second;
  };
  if (const double kinetic = slider_of("kinetic_friction", piece.kinetic_friction).to,
      least = slider_of("static_friction", piece.static_friction).from;
      kinetic > least)
    return fail(ErrorKind::unsuitable,
                fmt::format("the kinetic friction {:g} is above the static friction {:g}{}", kinetic, least,
                            piece.sliders.empty() ? "" : ", with each slider at its worse end"),
                where + "/kinetic_friction", "choose a static friction that is not smaller");
  if (!piece.texture && (piece.texture_gain != 1 || piece.sliders.contains("texture_gain")))
    return fail(ErrorKind::unsuitable, "the gain of a texture, but there is none", where + "/texture_gain",
                "give `texture`, or leave texture_gain out");
  TACTO_TRY(check_travel(piece, where + "/travel"));
  if (piece.texture) TACTO_TRY(check_piece_texture(piece, where + "/texture"));
  if (piece.relief) TACTO_TRY(check_relief(piece, where + "/relief"));
  if (piece.slide) TACTO_TRY(check_slide(*piece.slide, where + "/slide"));
  if (piece.transient && piece.hand_surface)
    return fail(ErrorKind::unsuitable, "a piece has one transient", where + "/hand_surface",
                "leave out `transient` or `hand_surface`");
  return piece.shape == PieceShape::quadric ? check_quadric(piece, where) : Result<void>();
}

}  // namespace

Result<void> check_pieces(const Scene& scene, const std::string& where) {
  if (scene.pieces.empty()) return {};
  if (!scene.patches.empty())
    return fail(ErrorKind::unsuitable, "a scene has patches in a plane, or pieces in space, but not both",
                where + "#/pieces", "make two scenes of it");
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
    const Piece& piece = scene.pieces[i];
    const std::string at = fmt::format("{}#/pieces/{}", where, i);
    if (!names.insert(piece.name).second)
      return fail(ErrorKind::unsuitable, fmt::format("two pieces are named '{}'", piece.name), at + "/name",
                  "give each piece its own name");
    TACTO_TRY(check_members(piece, at));
    if (scene.point_radius_m > 0 && (piece.shape == PieceShape::quadric || piece.shape == PieceShape::mesh ||
                                     piece.shape == PieceShape::volume || is_raised(piece)))
      return fail(ErrorKind::unsuitable,
                  "a point with a radius does not touch quadrics, meshes, reliefs and volumes yet",
                  where + "#/radius_m",
                  "leave radius_m out, or make the piece larger by the radius; planes, spheres and "
                  "cylinders are exact");
    if (!scene.tool_m.empty() && piece.shape != PieceShape::volume)
      return fail(ErrorKind::unsuitable,
                  fmt::format("a tool of points does not touch a {}", to_string(piece.shape)),
                  where + "#/tool_m", "it touches volumes; leave it out, or the other pieces");
    if (scene.contact == PieceContact::add && piece.shape == PieceShape::mesh)
      return fail(ErrorKind::unsuitable, "a mesh does not push to its nearest face", where + "#/contact",
                  "leave contact out: a ghost point touches meshes");
    if (scene.contact == PieceContact::add && is_raised(piece))
      return fail(ErrorKind::unsuitable, "a relief does not push to its nearest face", where + "#/contact",
                  "leave contact out: a ghost point touches reliefs");
  }
  return {};
}

}  // namespace tacto::schema

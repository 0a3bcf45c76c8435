// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a piece in space is stable on a force device, with the pieces that may act at the same place.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::playback {

struct JudgedPiece {
  schema::Piece total;                  ///< steepest_wall(), or the sum of those that act along its direction
  std::vector<std::string> with;        ///< the other pieces of that sum
  std::vector<std::string> unjudged;    ///< if not empty, a stable sum with these is not known
  double growth = 0;                    ///< wall_growth() of `total`
  schema::Piece alone = {};             ///< as judged
  schema::Piece along = {};             ///< spring and damper along the surface, where its friction holds
  std::vector<std::string> along_with;  ///< the other pieces of that sum
  double growth_along = 0;              ///< wall_growth() of `along`; 0 without friction

  bool is_unstable() const { return growth > 1 || growth_along > 1; }
};

/// growth_per_tick() of this wall on an axis of the device, above 1 it is unstable: with spring, integral and
/// a damper that acts on the difference of two places. A hand adds its mass, damping and stiffness. Coulomb
/// friction is left out, and the force limit. A piece that slides is judged at a stop, and as a mass that its
/// wall couples to the hand, without detents, dry friction and integral. Of all axes the largest; 0 if the
/// device states no mass.
double wall_growth(const schema::Piece& piece, const schema::Device& device, double rate_hz,
                   const std::optional<schema::Hand>& hand);

/// Its wall at its steepest: with a travel of the largest slope, and with a sine as texture of twice the
/// stiffness, damping and integral where the force along the normal is below the amplitude.
schema::Piece steepest_wall(const schema::Piece& piece);

/// Along the surface: the largest slope of a recorded force; of a bump at the peak force of the device along
/// the normal, its curvature, and on a sphere and a cylinder also its slope by their radius. The curvature of
/// quadrics and meshes is left out. `piece`: of read_reliefs().
double texture_stiffness_n_per_m(const schema::Piece& piece, const schema::Device& device);

/// Interpolated normals: the most energy that one way down the relief with the peak force of the device and
/// back up without one can give the hand: force x range of the heights, and what of the energy in the spring
/// a hand that goes in on the steepest slope and out on a flat place gains. 0 of other pieces. `piece`: of
/// read_reliefs().
double most_energy_j(const schema::Piece& piece, const schema::Device& device);

/// A piece with all that may act at the same place, at the worst of the ends of all sliders (slider_ends()).
/// `contact: add`: planes of the same direction add up, from the highest one down to the depth at which they
/// grow the most; with pieces that may overlap in another way a stable sum is not known. `ghost`: stiffnesses
/// do not add, because each wall holds its part of the way to the ghost; with the dampings of all pieces that
/// may hold the ghost together, not at a right angle, a wall that would grow is not known.
/// Along the surface a texture is a spring of texture_stiffness_n_per_m(). `scene`: of read_reliefs().
/// Friction that holds is a spring of the same stiffness along the surface, with the viscous
/// friction, which is a damper by itself, too; that of planes which add up adds up, and that of two planes at
/// a right angle along their edge. Along the normal of the other plane its wall has this friction beside it,
/// for a ghost the damper only. One that grows is unstable, up to where it slips. With the friction of all
/// pieces that may hold the ghost together at another angle, one that would grow is not known.
JudgedPiece judged_piece(const schema::Scene& scene, std::size_t index, const schema::Device& device,
                         double rate_hz, const std::optional<schema::Hand>& hand);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// A piece: a solid in space whose surface a point touches (Massie 1996), and the law of its wall.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace tacto::schema {

enum class PieceShape { plane, sphere, cylinder, quadric, mesh };

/// How pieces act: a ghost point stays on their surfaces (Zilles and Salisbury 1995), or each piece pushes to
/// its nearest face, and the forces add up.
enum class PieceContact { ghost, add };

/// Of x^2, y^2, z^2, xy, yz, xz, x, y, z and 1.
inline constexpr std::size_t kQuadricTerms = 10;

struct Piece {
  std::string name;  ///< different for each piece of a scene
  PieceShape shape = PieceShape::plane;
  double x_m = 0, y_m = 0, z_m = 0;             ///< a point of a plane or an axis, a centre, a mesh's origin
  std::array<double, 3> direction = {0, 0, 1};  ///< plane: out of the solid; cylinder: its axis
  double thickness_m = 0;                       ///< plane: of the plate below it; 0: without an end
  double radius_m = 0;                          ///< sphere, cylinder
  /// Quadric: solid where the sum of coefficient x term is below 0; terms in m, from the place.
  std::array<double, kQuadricTerms> coefficients = {};
  std::string mesh;  ///< mesh: the stem of its file, or the file
  double stiffness_n_per_m = 0;
  double damping_n_s_per_m = 0;
  double arrest_mass_kg = 0;  ///< the impulse at the beginning of a contact is this mass x the normal speed
  double integral_n_per_m_s = 0;   ///< growth of the force with depth and time
  double integral_bound_n = 0;     ///< most of that force
  double integral_leak_per_s = 0;  ///< share of that force which is lost per second
};

/// "plane", "sphere", "cylinder", "quadric", "mesh".
std::string_view to_string(PieceShape shape);

/// "ghost", "add".
std::string_view to_string(PieceContact contact);

}  // namespace tacto::schema

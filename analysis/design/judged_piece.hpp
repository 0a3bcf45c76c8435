// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a piece in space is stable on a force device, with the pieces that may act at the same place.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/design/design.hpp"

namespace tacto::analysis {

struct JudgedPiece {
  schema::Piece total;                ///< its wall, or the sum of those that act along its direction
  std::vector<std::string> with;      ///< the other pieces of that sum
  std::vector<std::string> unjudged;  ///< pieces that may act with it along an angle that is not computed
  double growth = 0;                  ///< playback::wall_growth() of `total`
  Stability verdict = Stability::stable;
  schema::Piece alone = {};  ///< as judged
  double growth_along = 0;   ///< along the surface, where its friction holds; 0 without friction
};

/// `contact: add`: planes of the same direction add up, from the highest one down to the depth at which they
/// grow the most; with pieces that may overlap in another way a stable sum is not known. `ghost`: stiffnesses
/// do not add, because each wall holds its part of the way to the ghost; with the dampings of all pieces that
/// may hold the ghost together, not perpendicular, a wall that would grow is not known. Friction that holds
/// is a spring of the same stiffness along the surface, with the viscous friction; one that grows is
/// unstable, up to where it slips. Viscous friction alone is a damper that may grow, too.
JudgedPiece judged_piece(const schema::Scene& scene, std::size_t index, const DesignRequest& request);

}  // namespace tacto::analysis

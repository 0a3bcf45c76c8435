// SPDX-License-Identifier: GPL-3.0-or-later
// The atoms of a field layer, from a CSV.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

inline constexpr std::size_t kMostAtoms = 4096;  ///< of a file; two thousand take 10 us a tick
/// No molecule is larger or stronger.
inline constexpr double kFarthestAtom_m = 1000, kMostAtomForce_n = 1e6;  ///< the force is epsilon / sigma

/// Its potential on a probe at a distance r: 4 epsilon ((sigma / r)^12 - (sigma / r)^6), with the sigma and
/// epsilon of the pair of atom and probe, and Coulomb's of its charge. Values are those of the molecule; a
/// field layer scales length and force.
struct Atom {
  double x_m = 0, y_m = 0, z_m = 0;
  double sigma_m = 0;    ///< above 0
  double epsilon_j = 0;  ///< 0 or above
  double charge_c = 0;
};

/// A CSV whose first line names the columns x_m, y_m, z_m, sigma_m, epsilon_j, charge_c, in any order. Empty
/// lines and lines that begin with # are ignored. At most kMostAtoms. Errors: not_found; malformed, with the
/// line: a column that is missing, twice, or unknown (with the nearest known one), a cell that is not a
/// finite number, a place, sigma or epsilon out of range, no atom, too many.
Result<std::vector<Atom>> read_atoms(const std::string& path);

}  // namespace tacto::schema

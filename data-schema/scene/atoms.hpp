// SPDX-License-Identifier: GPL-3.0-or-later
// The atoms of a field layer, from a CSV.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Its potential at a distance r: 4 epsilon ((sigma / r)^12 - (sigma / r)^6), and Coulomb's of its charge.
/// Values are scaled to the device: the atoms are as large as the hand's motion.
struct Atom {
  double x_m = 0, y_m = 0, z_m = 0;
  double sigma_m = 0;    ///< above 0
  double epsilon_j = 0;  ///< 0 or above
  double charge_c = 0;
};

/// A CSV whose first line names the columns x_m, y_m, z_m, sigma_m, epsilon_j, charge_c, in any order. Empty
/// lines and lines that begin with # are ignored. At most 2^20 atoms. Errors: not_found; malformed, with the
/// line: a column that is missing, twice, or unknown (with the nearest known one), a cell that is not a
/// finite number, a sigma or epsilon out of range, no atom, too many.
Result<std::vector<Atom>> read_atoms(const std::string& path);

}  // namespace tacto::schema

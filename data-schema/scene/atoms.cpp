// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/atoms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "data-schema/scene/number_rows.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kAtomColumns[] = {"x_m", "y_m", "z_m", "sigma_m", "epsilon_j", "charge_c"};

Result<void> check_atom(const Atom& atom, const std::string& path, std::size_t line) {
  const auto fault = [&](std::string what, std::string remedy) {
    return fault_in_line(path, line, std::move(what), std::move(remedy));
  };
  if (!(atom.sigma_m > 0)) return fault(fmt::format("sigma_m is {:g}", atom.sigma_m), "above 0");
  if (!(atom.epsilon_j >= 0)) return fault(fmt::format("epsilon_j is {:g}", atom.epsilon_j), "0 or above");
  if (const double force_n = atom.epsilon_j / atom.sigma_m; !(force_n <= kMostAtomForce_n))
    return fault(fmt::format("epsilon_j / sigma_m is {:g} N", force_n),
                 fmt::format("at most {:g} N", kMostAtomForce_n));
  for (const double place_m : {atom.x_m, atom.y_m, atom.z_m})
    if (!(std::abs(place_m) <= kFarthestAtom_m))
      return fault(fmt::format("a place is {:g} m", place_m),
                   fmt::format("within {:g} m of the origin", kFarthestAtom_m));
  return {};
}

}  // namespace

Result<std::vector<Atom>> read_atoms(const std::string& path) {
  const auto rows = read_number_rows(path, {kAtomColumns, kMostAtoms, "atom"});
  TACTO_TRY(rows);
  std::vector<Atom> atoms;
  for (std::size_t i = 0; i < rows->lines.size(); ++i) {
    const double* const cell = rows->cells.data() + i * std::size(kAtomColumns);
    atoms.push_back({cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]});
    TACTO_TRY(check_atom(atoms.back(), path, rows->lines[i]));
  }
  return atoms;
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/field_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::playback {
namespace {

static_assert(schema::kMostAtoms == core::kMostAtoms);

constexpr double kCoulombConstant = 8.9875517862e9;  // N m^2 / C^2: 1 / (4 pi epsilon_0), CODATA 2022
constexpr double kPeriodOfExtent = 4.25;             // above 4, so that differences of places do not wrap
constexpr double kLeastSigmaUnits = 65536, kMostUnitForce_n = 1;  // as core's read_scene_block()

}  // namespace

FieldSection field_section(const schema::FieldLayer& layer, const std::vector<schema::Atom>& atoms,
                           const schema::Patch& patch) {
  const double scale = layer.length_scale.value;
  FieldSection section{{}, layer.core.value, 0};
  double extent_m = std::max(patch.width_m, patch.height_m) / 2;
  for (const schema::Atom& atom : atoms) {
    const double sigma_m = atom.sigma_m;
    section.atoms.push_back({scale * atom.x_m, scale * atom.y_m, scale * atom.z_m, scale * sigma_m,
                             24 * atom.epsilon_j / (sigma_m * sigma_m * scale),
                             kCoulombConstant * atom.charge_c * layer.probe_charge_c.value /
                                 (sigma_m * sigma_m * sigma_m * scale)});
    extent_m = std::max({extent_m, std::abs(scale * atom.x_m), std::abs(scale * atom.y_m)});
  }
  section.period_m = kPeriodOfExtent * extent_m;
  return section;
}

std::vector<core::FieldAtom> FieldSection::in_units() const {
  const auto place = [&](double metres) { return static_cast<std::int32_t>(std::lround(metres / unit_m())); };
  std::vector<core::FieldAtom> made;
  for (const SectionAtom& atom : atoms) {
    const double sigma = atom.sigma_m / unit_m();
    made.push_back({place(atom.x_m), place(atom.y_m), static_cast<float>(atom.z_m / unit_m()),
                    static_cast<float>(sigma * sigma),
                    static_cast<float>(atom.lennard_jones_n_per_m * unit_m()),
                    static_cast<float>(atom.coulomb_n_per_m * unit_m())});
  }
  return made;
}

schema::Result<void> check_section(const FieldSection& section, const std::string& where) {
  for (std::size_t i = 0; i < section.atoms.size(); ++i) {
    const SectionAtom& atom = section.atoms[i];
    if (!(atom.sigma_m >= kLeastSigmaUnits * section.unit_m() && atom.sigma_m <= 1e4 * section.period_m))
      return schema::fail(
          schema::ErrorKind::unsuitable,
          fmt::format("with its length_scale, sigma of atom {} is {:g} m on the bench, on a patch, or beside "
                      "atoms, that reach {:g} m from the centre",
                      i + 1, atom.sigma_m, section.period_m / kPeriodOfExtent),
          where,
          "choose length_scale so that atoms are as large as motions of the hand: above a 15000th of that");
    const double force_n =
        std::max(atom.lennard_jones_n_per_m, std::abs(atom.coulomb_n_per_m)) * section.unit_m();
    if (!(force_n <= kMostUnitForce_n))
      return schema::fail(schema::ErrorKind::unsuitable,
                          fmt::format("the force constants of atom {} are {:g} and {:g} N/m on the bench",
                                      i + 1, atom.lennard_jones_n_per_m, atom.coulomb_n_per_m),
                          where, "check epsilon_j, sigma_m and the charges, which are in J, m and C");
    if (!(std::abs(atom.z_m) <= 2 * section.period_m))
      return schema::fail(schema::ErrorKind::unsuitable,
                          fmt::format("atom {} is {:g} m above the plane on the bench, on a patch, or beside "
                                      "atoms, that reach {:g} m from the centre",
                                      i + 1, atom.z_m, section.period_m / kPeriodOfExtent),
                          where, "leave atoms out that are far from the section");
  }
  return {};
}

double field_rounding_n(const FieldSection& section, const schema::Patch& patch, double low_z_m,
                        double high_z_m) {
  constexpr double kUnit = 0x1p-24, kRoundings = 64;  // s^7 has 35 of them
  constexpr int kParts = 32;
  const double half_m[2] = {patch.width_m / (2 * kParts), patch.height_m / (2 * kParts)};
  const double farthest_z_m = std::max(std::abs(low_z_m), std::abs(high_z_m));
  const auto beyond = [](double value, double low, double high) {
    return std::max({0.0, low - value, value - high});
  };
  const auto of_part = [&](double x_m, double y_m) {
    double sum = 0;
    for (const SectionAtom& atom : section.atoms) {
      const double x = beyond(atom.x_m, x_m - half_m[0], x_m + half_m[0]),
                   y = beyond(atom.y_m, y_m - half_m[1], y_m + half_m[1]),
                   z = beyond(atom.z_m, low_z_m, high_z_m);
      const double distance_m = std::max(section.core * atom.sigma_m, std::sqrt(x * x + y * y + z * z));
      const double ratio = atom.sigma_m / distance_m, s = ratio * ratio, s4 = s * s * s * s,
                   s7 = s4 * s * s * s;
      const double coulomb = std::abs(atom.coulomb_n_per_m) * s * ratio;
      const double force = (atom.lennard_jones_n_per_m * (2 * s7 + s4) + coulomb) * distance_m,
                   stiffness = atom.lennard_jones_n_per_m * (26 * s7 + 7 * s4) + 2 * coulomb;
      const double place_m = 3 * section.unit_m() + 2 * kUnit * (std::abs(atom.z_m) + farthest_z_m);
      sum += force * kUnit * (kRoundings + static_cast<double>(section.atoms.size())) + stiffness * place_m;
    }
    return sum;
  };
  double largest = 0;
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < kParts; ++j)
      largest =
          std::max(largest, of_part((2 * i + 1 - kParts) * half_m[0], (2 * j + 1 - kParts) * half_m[1]));
  return largest;
}

}  // namespace tacto::playback

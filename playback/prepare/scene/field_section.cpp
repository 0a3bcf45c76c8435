// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/field_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::playback {
namespace {

static_assert(schema::kMostAtoms == core::kMostAtoms);

constexpr double kCoulombConstant = 8.9875517862e9;  // N m^2 / C^2: 1 / (4 pi epsilon_0), CODATA 2022
constexpr double kPeriodOfExtent = 4.25;             // above 4, so that differences of places do not wrap
constexpr double kLeastSigmaUnits = 65536, kMostUnitForce_n = 1;  // as core's read_scene_block()
constexpr int kDirections = 8, kGrid = 64;

// -dF/dplace of all atoms: symmetric, because each force is along the distance.
struct Derivative {
  double xx = 0, xy = 0, yy = 0;

  double largest() const { return std::abs(0.5 * (xx + yy)) + std::hypot(0.5 * (xx - yy), xy); }
};

// F = g d; outside the core s = sigma^2 / d^2 and dg/d(d^2) = -s^2 / sigma^2 dg/ds, inside both are constant.
void add_atom(Derivative& sum, const SectionAtom& atom, double core, double x_m, double y_m, double z_m) {
  const double dx = x_m - atom.x_m, dy = y_m - atom.y_m, dz = z_m - atom.z_m;
  const double sigma2 = atom.sigma_m * atom.sigma_m, square = dx * dx + dy * dy + dz * dz;
  const bool inside = square <= core * core * sigma2;
  const double s = inside ? 1 / (core * core) : sigma2 / square, s3 = s * s * s, root = std::sqrt(s);
  const double g = atom.lennard_jones_n_per_m * (2 * s3 * s3 * s - s3 * s) + atom.coulomb_n_per_m * s * root;
  const double by_s =
      atom.lennard_jones_n_per_m * (14 * s3 * s3 - 4 * s3) + atom.coulomb_n_per_m * 1.5 * root;
  const double along = inside ? 0 : 2 * by_s * s * s / sigma2;
  sum.xx += along * dx * dx - g, sum.xy += along * dx * dy, sum.yy += along * dy * dy - g;
}

double stiffness_at(const FieldSection& section, double x_m, double y_m, double z_m) {
  Derivative sum;
  for (const SectionAtom& atom : section.atoms) add_atom(sum, atom, section.core, x_m, y_m, z_m);
  return sum.largest();
}

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

double stiffest_n_per_m(const FieldSection& section, const schema::LayerNumber& z_m,
                        const schema::Patch& patch) {
  const double low_m = z_m.slider ? z_m.slider->from : z_m.value,
               high_m = z_m.slider ? z_m.slider->to : z_m.value;
  double stiffest = 0;
  const auto visit = [&](double x_m, double y_m, double at_z_m) {
    if (std::abs(x_m) <= patch.width_m / 2 && std::abs(y_m) <= patch.height_m / 2)
      stiffest = std::max(stiffest, stiffness_at(section, x_m, y_m, at_z_m));
  };
  for (const SectionAtom& atom : section.atoms) {
    const double at_z_m = std::clamp(atom.z_m, low_m, high_m), dz = at_z_m - atom.z_m,
                 radius_m = section.core * atom.sigma_m * (1 + 1e-9);
    visit(atom.x_m, atom.y_m, at_z_m);
    if (radius_m <= std::abs(dz)) continue;
    const double in_plane_m = std::sqrt(radius_m * radius_m - dz * dz);
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * std::numbers::pi * i / kDirections;
      visit(atom.x_m + in_plane_m * std::cos(angle), atom.y_m + in_plane_m * std::sin(angle), at_z_m);
    }
  }
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j)
      visit(patch.width_m * ((i + 0.5) / kGrid - 0.5), patch.height_m * ((j + 0.5) / kGrid - 0.5), z_m.value);
  return stiffest;
}

double field_rounding_n(const FieldSection& section, double farthest_z_m) {
  constexpr double kUnit = 0x1p-24, kRoundings = 64;  // s^7 has 35 of them
  const double core = section.core, s = 1 / (core * core), s4 = s * s * s * s, s7 = s4 * s * s * s;
  double sum = 0;
  for (const SectionAtom& atom : section.atoms) {
    const double coulomb = std::abs(atom.coulomb_n_per_m) * std::pow(s, 1.5);
    const double force = (atom.lennard_jones_n_per_m * (2 * s7 + s4) + coulomb) * core * atom.sigma_m,
                 stiffness = atom.lennard_jones_n_per_m * (26 * s7 + 7 * s4) + 2 * coulomb;
    const double place_m = 3 * section.unit_m() + 2 * kUnit * (std::abs(atom.z_m) + std::abs(farthest_z_m));
    sum += force * kUnit * (kRoundings + static_cast<double>(section.atoms.size())) + stiffness * place_m;
  }
  return sum;
}

}  // namespace tacto::playback

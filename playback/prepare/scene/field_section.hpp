// SPDX-License-Identifier: GPL-3.0-or-later
// The atoms of a field layer, as the kernel sums them in the plane of a patch, and what follows from them.
#pragma once

#include <cstdint>
#include <vector>

#include "data-schema/scene/atoms.hpp"
#include "data-schema/scene/patch.hpp"
#include "firmware-host/core/scene/field.hpp"

namespace tacto::playback {

/// Lengths are on the bench; force constants for a force_scale of 1.
struct SectionAtom {
  double x_m = 0, y_m = 0, z_m = 0, sigma_m = 0;
  double lennard_jones_n_per_m = 0;  ///< 24 epsilon / sigma^2
  double coulomb_n_per_m = 0;        ///< q Q / (4 pi epsilon_0 sigma^3)
};

/// The atoms around the centre of a patch, in its axes.
struct FieldSection {
  std::vector<SectionAtom> atoms;
  double core = 1;
  /// Of the rows of the kernel's table: 4.25 times the largest distance of an atom or of the border from the
  /// centre, along x or y.
  double period_m = 0;

  double unit_m() const { return period_m * 0x1p-32; }
  std::vector<core::FieldAtom> in_units() const;
};

FieldSection field_section(const schema::FieldLayer& layer, const std::vector<schema::Atom>& atoms,
                           const schema::Patch& patch);

/// Errors, at `where`: unsuitable: a sigma below 2^16 units, so that the place would be too coarse, or a
/// force constant beyond 1 N per unit.
schema::Result<void> check_section(const FieldSection& section, const std::string& where);

/// How much the kernel's force differs from that in double precision at most, for a force_scale of 1, on a
/// hand in the patch, with the section from `low_z_m` to `high_z_m`: of each atom 64 roundings, those of the
/// sum, and the rounding of places to a unit and of z to single precision. Largest of 32 x 32 parts of the
/// patch, in each with every atom as near as the part permits: from the core on, both bounds of an atom fall
/// with its distance.
double field_rounding_n(const FieldSection& section, const schema::Patch& patch, double low_z_m,
                        double high_z_m);

}  // namespace tacto::playback

// SPDX-License-Identifier: Apache-2.0
// The force of atoms on a hand in a plane section through them (Minsky 1990, after equation 6: F = sum
// f(x_i)).
#pragma once

#include <stdint.h>

namespace tacto::core {

inline constexpr uint32_t kMostAtoms = 4096;

/// An atom in units of the table (FieldTable). Its force on a hand at the distance vector d, in the plane:
///   s = squared_sigma / max(d^2, core squared_sigma);  (lennard_jones (2 s^7 - s^4) + coulomb s^(3/2)) d.
/// Outside its core this is Lennard-Jones's and Coulomb's force, with lennard_jones = 24 epsilon / sigma^2
/// and coulomb = k q Q / sigma^3; inside it falls linearly to 0 at the centre, so that it is bounded,
/// continuous and still the gradient of a potential.
struct FieldAtom {
  int32_t x = 0, y = 0;
  float z = 0;
  float squared_sigma = 1;
  float lennard_jones = 0, coulomb = 0;  ///< N per unit of length, for a force_scale of 1
};
static_assert(sizeof(FieldAtom) == 24);

struct FieldForce {
  float x = 0, y = 0;  ///< N, for a force_scale of 1
};

/// The sum over `count` atoms on a hand at (x, y, z). `core`: the squared ratio of the core's radius to
/// sigma. Differences of x and y are exact, modulo 2^32. In single precision within 1e-5 of the sum of the
/// absolute forces of both kinds at the same places. Without branches: 20 operations, a division and a square
/// root per atom. Safe in the tick.
FieldForce field_force(const FieldAtom* atoms, uint32_t count, float core, int32_t x, int32_t y,
                       float z) noexcept;

}  // namespace tacto::core

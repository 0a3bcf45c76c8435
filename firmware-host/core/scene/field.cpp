// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/field.hpp"

namespace tacto::core {
namespace {

float difference(int32_t a, int32_t b) noexcept {
  return static_cast<float>(static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b)));
}

}  // namespace

FieldForce field_force(const FieldAtom* atoms, uint32_t count, float core, int32_t x, int32_t y,
                       float z) noexcept {
  FieldForce sum;
  for (uint32_t i = 0; i < count; ++i) {
    const FieldAtom& atom = atoms[i];
    const float dx = difference(x, atom.x), dy = difference(y, atom.y), dz = z - atom.z;
    const float square = dx * dx + dy * dy + dz * dz, least = core * atom.squared_sigma;
    const float s = atom.squared_sigma / (square > least ? square : least);
    const float s2 = s * s, s4 = s2 * s2;
    const float force =
        atom.lennard_jones * (s4 * (2 * s2 * s - 1)) + atom.coulomb * (s * __builtin_sqrtf(s));
    sum.x += force * dx;
    sum.y += force * dy;
  }
  return sum;
}

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// A place on a lattice in fixed point: the whole cell and the part within it. Single precision would lose the
// part far from the origin.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// Places in units of one cell, with 32 bits after the point: from -2^31 to 2^31 cells.
using Q32 = int64_t;

struct LatticePlace {
  int32_t cell = 0;
  float part = 0;  ///< 0 <= part <= 1: rounding may end at the next cell's beginning
};

/// Safe in the tick.
inline LatticePlace lattice_place(Q32 place) noexcept {
  return {static_cast<int32_t>(place >> 32), static_cast<float>(static_cast<uint32_t>(place)) * 0x1p-32F};
}

/// Held within 2^30 cells. Safe in the tick.
inline Q32 fixed_point(float cells) noexcept {
  constexpr float kMost = 0x1p30F;
  const float held = cells < -kMost ? -kMost : cells < kMost ? cells : kMost;
  const auto whole = static_cast<int32_t>(held);
  const auto half_parts = static_cast<int32_t>((held - static_cast<float>(whole)) * 0x1p31F);
  return (int64_t{whole} << 32) + int64_t{half_parts} * 2;
}

/// The same place on a lattice that is 2^octave times as fine. Wraps beyond 2^31 cells, like the lattice's
/// noise.
inline Q32 finer(Q32 place, uint32_t octave) noexcept {
  return static_cast<Q32>(static_cast<uint64_t>(place) << octave);
}

}  // namespace tacto::core

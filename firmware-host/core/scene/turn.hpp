// SPDX-License-Identifier: Apache-2.0
// Sine and cosine of a phase in fixed point, without libm.
#pragma once

#include <stdint.h>

namespace tacto::core {

struct SineCosine {
  float sine = 0, cosine = 1;
};

/// Of `turns` / 2^32 of a turn: Taylor's series in the eighth of a turn around the nearest quarter. Error
/// below 1e-7. Safe in the tick.
inline SineCosine sine_cosine(uint32_t turns) noexcept {
  const uint32_t quarter = (turns + (UINT32_C(1) << 29)) >> 30;
  const float x = static_cast<float>(static_cast<int32_t>(turns - (quarter << 30))) * (6.2831853F * 0x1p-32F);
  const float q = x * x;
  const float s = x * (1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72))));
  const float c = 1 - q / 2 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90))));
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace tacto::core

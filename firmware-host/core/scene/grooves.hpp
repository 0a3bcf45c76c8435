// SPDX-License-Identifier: Apache-2.0
// The profile of parallel grooves as a cosine series, without harmonics that alias at the finger's speed.
#pragma once

#include <stdint.h>

#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

inline constexpr uint32_t kMostHarmonics = 64;

/// h = sum of amplitude[n - 1] cos(2 pi n phase), n from 1.
struct Grooves {
  const float* amplitude = nullptr;
  uint32_t harmonics = 0;
};

struct GrooveSample {
  float value = 0;
  float by_phase = 0;  ///< derivative, per period
};

inline constexpr float kWholePerTick = 0.375F, kZeroPerTick = 0.5F;  ///< cycles

/// 1 for frequencies up to 3/8 of the tick rate, 0 from half of it on, in between 1 - s^2 (3 - 2 s). Safe in
/// the tick.
inline float held_by_rate(float cycles_per_tick) noexcept {
  const float s = (cycles_per_tick - kWholePerTick) * (1 / (kZeroPerTick - kWholePerTick));
  if (!(s > 0)) return 1;
  return s < 1 ? 1 - s * s * (3 - 2 * s) : 0;
}

/// Value and exact derivative at a phase (2^32 is a period) for a finger that passes `periods_per_tick` (not
/// negative) periods per tick. Clenshaw's recurrence; the error is below 2e-7 times the sum of n |amplitude|.
/// Safe in the tick.
GrooveSample groove_at(const Grooves& grooves, uint32_t phase, float periods_per_tick) noexcept;

}  // namespace tacto::core

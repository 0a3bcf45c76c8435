// SPDX-License-Identifier: Apache-2.0
// Tests for finite numbers.
#pragma once

namespace tacto::core {

inline constexpr float kLargestFloat = 3.4028235e38F;

/// False for NaN and the infinities. Safe in the tick.
constexpr bool is_finite(float value) noexcept {
  return value >= -kLargestFloat && value <= kLargestFloat;
}

/// True if `value` is a number in [least, most].
constexpr bool within(float value, float least, float most) noexcept {
  return value >= least && value <= most;
}

}  // namespace tacto::core

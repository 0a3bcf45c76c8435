// SPDX-License-Identifier: Apache-2.0
// The level of detail for a speed.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// Half octaves above the speed up to which the first level of a pyramid is used: the integer part, from 0,
/// and the fraction.
struct Detail {
  uint32_t coarser = 0;
  float fade = 0;  ///< 0 <= fade < 1
};

/// 2 log2(ratio), without libm: error below 0.02, continuous and increasing, exact at powers of two; 0 for
/// ratios below 1. In integer arithmetic, so that the level is available early in the tick. Safe in the tick.
inline Detail detail_at(float ratio) noexcept {
  if (!(ratio > 1)) return {};
  uint32_t bits;
  __builtin_memcpy(&bits, &ratio, sizeof bits);
  constexpr uint32_t kOne = UINT32_C(0x3F800000), kUnit = UINT32_C(1) << 23;
  constexpr auto kBend = static_cast<uint32_t>(0.3431 * kUnit);
  // Exponent and mantissa m give a piecewise linear log2 in units of 2^-23; the correction is log2(1 + m) =
  // about m + 0.3431 m (1 - m).
  const uint32_t m = bits & (kUnit - 1);
  const auto bend = static_cast<uint32_t>(static_cast<uint64_t>(m) * (kUnit - m) >> 23);
  const uint32_t log2_q23 = bits - kOne + static_cast<uint32_t>(static_cast<uint64_t>(bend) * kBend >> 23);
  constexpr uint32_t kHalf = kUnit / 2;
  return {log2_q23 / kHalf, static_cast<float>(static_cast<int32_t>(log2_q23 % kHalf)) * (1.0F / kHalf)};
}

/// The same as one number.
inline float half_octaves(float ratio) noexcept {
  const Detail detail = detail_at(ratio);
  return static_cast<float>(detail.coarser) + detail.fade;
}

}  // namespace tacto::core

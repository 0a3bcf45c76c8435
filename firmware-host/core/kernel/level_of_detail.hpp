// SPDX-License-Identifier: Apache-2.0
// How much detail can be played at a speed.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// Half octaves of speed above the speed up to which a pyramid's first level is used: whole ones, 0 and more,
/// and the fraction of the next.
struct Detail {
  uint32_t coarser = 0;
  float fade = 0;  ///< 0 <= fade < 1
};

/// 2 log2(ratio), without libm: within 0.02, continuous and growing, exact at powers of two; 0 for ratios
/// below 1. In integers, so that the level is known soon. Safe in the tick.
inline Detail detail_at(float ratio) noexcept {
  if (!(ratio > 1)) return {};
  uint32_t bits;
  __builtin_memcpy(&bits, &ratio, sizeof bits);
  constexpr uint32_t kOne = UINT32_C(0x3F800000), kUnit = UINT32_C(1) << 23;
  constexpr auto kBend = static_cast<uint32_t>(0.3431 * kUnit);
  // Exponent and rest m make log2 in parts of 2^23 but for the bend: log2(1 + m) is about m + 0.3431 m (1 -
  // m).
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

// SPDX-License-Identifier: Apache-2.0
// Four floats at once.
#pragma once

namespace tacto::core {

/// The processor's vector where it has one, four floats in a row where it has none: the same operations in
/// the same order, and so the same bits.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 load_float4(const float* values) noexcept {
  Float4 four;
  __builtin_memcpy(&four, values, sizeof four);
  return four;
}

inline void store_four(float* values, Float4 four) noexcept {
  __builtin_memcpy(values, &four, sizeof four);
}

/// The order is part of the result, and the same everywhere.
inline float sum_of(Float4 four) noexcept {
  return (four[0] + four[2]) + (four[1] + four[3]);
}

}  // namespace tacto::core

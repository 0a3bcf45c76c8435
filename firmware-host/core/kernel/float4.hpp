// SPDX-License-Identifier: Apache-2.0
// A vector of four floats.
#pragma once

namespace tacto::core {

/// The vector type of the processor if it has one, otherwise four floats: the same operations in the same
/// order, so the same bits.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 load_float4(const float* values) noexcept {
  Float4 four;
  __builtin_memcpy(&four, values, sizeof four);
  return four;
}

inline void store_four(float* values, Float4 four) noexcept {
  __builtin_memcpy(values, &four, sizeof four);
}

/// The order is fixed, so that the bits are the same everywhere.
inline float sum_of(Float4 four) noexcept {
  return (four[0] + four[2]) + (four[1] + four[3]);
}

}  // namespace tacto::core

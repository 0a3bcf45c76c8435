// SPDX-License-Identifier: Apache-2.0
// Interpolation between samples.
#pragma once

#include "firmware-host/core/kernel/float4.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::core {

/// The number of samples that an interpolation may read: y[kBefore] is the one at or before the position.
inline constexpr int32_t kReach = 8, kBefore = 3;

/// The weights of kReach samples.
struct Weights {
  Float4 low, high;
};

/// The weights for the position y[kBefore] + u, 0 <= u < 1. With w = 2 pi k pitch for a sinusoid of spatial
/// frequency k, the errors relative to its amplitude, measured for w from 0.06 to 0.63 (ten samples per
/// period), are:
/// - nearest: the closer sample; at most 0.5 w.
/// - linear: at most 0.125 w^2.
/// - hermite: cubic, slopes from central differences of fourth order, m_i = (8 (y_i+1 - y_i-1) - (y_i+2 -
/// y_i-2)) / 12: at most 0.0026 w^4 + 0.0032 w^5, and 4e-7 for single precision.
/// - sinc: eight samples with a Kaiser window (beta 8), for profiles with few samples per period: at most
/// 6e-4 up to w = 1.05 (six samples per period), where hermite has an error of 7e-3.
/// Safe in the tick.
Weights weights_at(wire::Interpolation kind, float u) noexcept;

/// The weighted samples before summation, because levels are blended first.
inline Float4 weighted(wire::Interpolation kind, const float* y, float u) noexcept {
  const Weights weights = weights_at(kind, u);
  return weights.low * load_float4(y) + weights.high * load_float4(y + 4);
}

/// The interpolated value.
inline float interpolated(wire::Interpolation kind, const float* y, float u) noexcept {
  return sum_of(weighted(kind, y, u));
}

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// Improved gradient noise (Perlin, "Improving noise", SIGGRAPH 2002), its gradient, and sums of its octaves.
#pragma once

#include <stdint.h>

#include "firmware-host/core/scene/lattice_place.hpp"

namespace tacto::core {

/// The order of the lattice's gradients: a permutation of 0 to 255.
struct NoiseTable {
  uint8_t order[256];
};

/// The permutation of Perlin's program.
extern const NoiseTable kPerlinNoise;

/// Perlin's permutation, shuffled by a seed (Fisher and Yates with xorshift32); seed 0 leaves it as it is.
NoiseTable shuffled_noise(uint32_t seed) noexcept;

struct NoiseSample {
  float value = 0;           ///< within -1 and 1 for one octave
  float by_x = 0, by_y = 0;  ///< derivatives, per cell of the first octave
};

/// One octave. Within 2e-7 of the same in double precision (value) and 2e-6 (derivatives). Safe in the tick.
NoiseSample noise(const NoiseTable& table, Q32 x, Q32 y, Q32 z) noexcept;

inline constexpr uint32_t kMostOctaves = 16;

/// Up to this frequency of its sections, in cycles per cell, an octave is played whole: above it lies 0.15 %
/// of the power of its slope, by a spectrum of 2e6 places.
inline constexpr float kNoiseCycles = 2;

/// Octave i is 2^i times as fine and weighted with weights[i]: for a fractal of roughness H, 2^(-H i), times
/// what the finger's speed leaves of it. Octaves of weight 0 are not computed. Precondition: octaves <=
/// kMostOctaves. Safe in the tick.
NoiseSample fractal_noise(const NoiseTable& table, Q32 x, Q32 y, Q32 z, const float* weights,
                          uint32_t octaves) noexcept;

}  // namespace tacto::core

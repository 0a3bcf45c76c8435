// SPDX-License-Identifier: GPL-3.0-or-later
// The octaves of a noise layer.
#pragma once

#include <cmath>
#include <vector>

#include "data-schema/scene/force_layer.hpp"

namespace tacto::playback {

/// Amplitudes of the octaves, from the lowest on, for a depth of 1: roughness^i, so scaled that the heights
/// are within -1/2 and 1/2 (one octave of noise is within -1 and 1).
inline std::vector<double> octave_amplitudes(const schema::NoiseLayer& noise) {
  std::vector<double> amplitudes;
  double sum = 0;
  for (int i = 0; i < std::lround(noise.octaves.value); ++i) {
    amplitudes.push_back(std::pow(noise.roughness.value, i));
    sum += 2 * amplitudes.back();
  }
  for (double& amplitude : amplitudes) amplitude /= sum;
  return amplitudes;
}

}  // namespace tacto::playback

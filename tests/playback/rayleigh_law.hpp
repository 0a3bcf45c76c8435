// SPDX-License-Identifier: GPL-3.0-or-later
// The hysteresis of the emulated bender as in a transducer's file.
#pragma once

#include <algorithm>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::playback {

/// Rayleigh's law between +-limit: play operators of equal weight at even thresholds, with the given opening.
inline schema::Hysteresis rayleigh(double opening, double limit_v, int play_operators) {
  schema::Hysteresis law{{0}, {0}};
  double ends = 0, apart = 0;
  for (int i = 0; i < play_operators; ++i) {
    const double threshold_v = limit_v * (i + 0.5) / play_operators;
    law.thresholds_v.push_back(threshold_v);
    ends += limit_v - threshold_v;
    apart += std::min(threshold_v, limit_v - threshold_v);
  }
  const double weight = opening * limit_v / apart;
  law.weights.assign(law.thresholds_v.size(), weight);
  law.weights[0] = 1 - weight * ends / limit_v;
  return law;
}

}  // namespace tacto::playback

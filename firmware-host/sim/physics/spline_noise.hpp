// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth random curves: the slow wander of a hand, the long waves of a surface.
#pragma once

#include <array>
#include <cstdint>

#include "firmware-host/sim/physics/random.hpp"

namespace tacto::firmware_host {

/// A random curve of mean 0 and RMS 1: uniform cubic B-splines on independent normal coefficients, twice
/// continuously differentiable. Its power falls by 3 dB at 0.23 and by 20 dB at 0.56 cycles per knot.
class SplineNoise {
 public:
  SplineNoise(Random random, double knot_spacing);

  /// The curve at `place`, in the unit of the spacing. Places must not be negative, nor decrease from call to
  /// call.
  double at(double place);

 private:
  void go_to_knot(std::int64_t knot);

  Random random_;
  double knots_per_unit_;
  std::int64_t knot_ = 0;
  std::array<double, 4> coefficients_;
};

}  // namespace tacto::firmware_host

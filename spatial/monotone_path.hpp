// SPDX-License-Identifier: GPL-3.0-or-later
// A stroke's positions made strictly monotone within their quantum, so that they can be inverted.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// Knots of S_x: when the finger was where. `way_m` is position x direction, so that it always grows.
struct MonotonePath {
  std::vector<double> sample;  ///< time, in samples from the stretch's first; strictly increasing
  std::vector<double> way_m;   ///< strictly increasing
  double moved_m = 0;          ///< how far conditioning moved any position, at most
};

/// What increases strictly stays as it is, to the bit. Else the closest non-decreasing path is taken
/// (isotonic regression by pooling adjacent violators), and where the position then stands still it is let
/// creep from first to last of these samples, by less than `quantum_m` in all and by less than half the way
/// to its neighbours: a slow even motion that was rounded comes back even. Without a quantum (0) it creeps by
/// a thousandth of the way to its neighbours. Empty where fewer than 2 different positions remain.
MonotonePath monotone_path(std::span<const double> position_m, int direction, double quantum_m);

}  // namespace tacto::spatial

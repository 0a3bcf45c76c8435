// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a stroke's positions strictly monotone within their quantum and noise, so that they can be inverted.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// Knots of S_x: position against time. `way_m` is position x direction, so it always increases.
struct MonotonePath {
  std::vector<double> sample;  ///< time, in samples from the section's first; strictly increasing
  std::vector<double> way_m;   ///< strictly increasing
  double moved_m = 0;          ///< largest change of any position by the conditioning
};

/// The error of a position: `quantum_m` is the full width of its rounding, `noise_m` a standard deviation. 0
/// if there is none.
struct PositionError {
  double quantum_m = 0;
  double noise_m = 0;

  /// The largest change of a position that its errors explain: a quantum and 6 standard deviations (1 in 5e8
  /// values of Gaussian noise is further off). A larger change means that the finger really moved backwards.
  double error_bound_m() const { return quantum_m + kNoiseReach * noise_m; }
  static constexpr double kNoiseReach = 6;
};

/// A strictly increasing position stays the same to the bit. Otherwise noise, if there is any, is averaged
/// out first (see smoothed_way()). Then the closest non-decreasing path is computed (isotonic regression by
/// pooling adjacent violators). Where the position is then constant, it is replaced by a slow uniform motion
/// (creep) from the first to the last of these samples. The creep is less than the quantum (or one standard
/// deviation of the noise) in total and less than half the distance to the neighbours, so that a slow uniform
/// motion that was rounded is restored. Without quantum and noise the creep is a thousandth of the distance
/// to the neighbours. The result is empty if fewer than 2 different positions remain.
MonotonePath monotone_path(std::span<const double> position_m, int direction, PositionError error);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// A stroke's positions made strictly monotone within their quantum and noise, so that they can be inverted.
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

/// How far a position may be off: `quantum_m` from end to end of its rounding, `noise_m` as a standard
/// deviation. 0 where there is none.
struct PositionError {
  double quantum_m = 0;
  double noise_m = 0;

  /// What conditioning may have to move positions by: a quantum, and 6 standard deviations (1 in 5e8 of
  /// Gaussian noise is further off). What moves further went backwards in truth.
  double explains_m() const { return quantum_m + kNoiseReach * noise_m; }
  static constexpr double kNoiseReach = 6;
};

/// What increases strictly stays as it is, to the bit. Else noise, where there is any, is averaged out first
/// (see smoothed_way()). Then the closest non-decreasing path is taken (isotonic regression by pooling
/// adjacent violators), and where the position then stands still it is let creep from first to last of these
/// samples, by less than its quantum (or one standard deviation of its noise) in all and by less than half
/// the way to its neighbours: a slow even motion that was rounded comes back even. Without either it creeps
/// by a thousandth of the way to its neighbours. Empty where fewer than 2 different positions remain.
MonotonePath monotone_path(std::span<const double> position_m, int direction, PositionError error);

/// The way (position x direction) averaged over the longest window (a half to both sides of 2^k samples, at
/// most an eighth of all) that moves no position by more than 6 standard deviations of its noise; unchanged
/// where none does. An average A is taken as 2 A - A A, which keeps a motion of even acceleration as it is
/// (Tukey's twicing). Slips after a stick, which a window would blur, so leave the window short.
std::vector<double> smoothed_way(std::span<const double> way_m, double noise_m);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of a record's positions: the step of their grid, their noise, and the speed of travel.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "data-schema/base/error.hpp"
#include "spatial/numbers/log_histogram.hpp"
#include "spatial/strokes/frame_range.hpp"

namespace tacto::spatial {

struct PositionFacts {
  /// The step of the positions' grid, e.g. of an encoder; 0 if there is none, e.g. for a nominal position. m.
  double quantum_m = 0;
  /// Standard deviation of their noise if it is more than a quantum, e.g. of an LVDT; otherwise 0. m.
  double noise_m = 0;
  /// The speed, over 20 ms, below which half of the distance was travelled; pauses of any length have no
  /// weight. m/s.
  double travelling_mps = 0;

  /// The difference of two positions that proves a movement of the finger: the quantum, or the difference
  /// that two noisy readings exceed 1 time in 10. m.
  double resolution_m() const { return std::max(quantum_m, 2.4 * noise_m); }
};

/// Estimates quantum and noise from sections of positions, in any order.
class PositionSteps {
 public:
  explicit PositionSteps(double sample_rate_hz);
  /// Adds the first `count` of the positions. The span has kAhead more positions after them, if the section
  /// has so many.
  void add(std::span<const double> position_m, std::size_t count);
  static constexpr std::size_t kAhead = 32;

  /// The smallest change from one step to the next that exceeds rounding (1e-12 of `furthest_m`, the largest
  /// position). 0 if over 99 % of the steps of the moving finger are equal.
  double quantum_m(double furthest_m) const;
  /// From fourth differences, in which the finger's own motion almost cancels (below 10 nm at 3 Hz and 40
  /// mm), with lags up to 1 ms, so that noise after a low-pass is found too: median / 0.6745 / sqrt(70),
  /// exact for white Gaussian noise. 0 unless it exceeds `quantum_m`, whose rounding has the same effect, and
  /// the rounding of doubles.
  double noise_m(double quantum_m, double furthest_m) const;

 private:
  static constexpr std::array<std::size_t, 4> kLags = {1, 2, 4, 8};
  double sample_rate_hz_;
  LogHistogram steps_, changes_;
  std::array<LogHistogram, kLags.size()> bends_;
};

/// `pieces` are between gaps, `furthest_m` is the largest |position|. Reads all frames twice. Errors: of
/// reading.
schema::Result<PositionFacts> position_facts(const ReadFrames& read, std::span<const FrameRange> pieces,
                                             double sample_rate_hz, double furthest_m);

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// What a record's positions can tell: the step of their grid, their noise, how fast the finger travels.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "data-schema/base/error.hpp"
#include "spatial/numbers/log_histogram.hpp"
#include "spatial/strokes/frame_range.hpp"

namespace tacto::spatial {

struct PositionFacts {
  /// The step of the positions' grid, as of an encoder; 0 where none shows, as of a nominal position. m.
  double quantum_m = 0;
  /// Standard deviation of their noise where that is over a quantum, as of an LVDT; else 0. m.
  double noise_m = 0;
  /// The speed at which half of the whole way was gone, over 20 ms: pauses, however long, weigh nothing. m/s.
  double travelling_mps = 0;

  /// What two positions must differ by, so that the finger has moved for certain: the quantum, or the
  /// difference that two noisy readings leave 1 time in 10. m.
  double resolution_m() const { return std::max(quantum_m, 2.4 * noise_m); }
};

/// Learns quantum and noise from stretches of positions; their order is free.
class PositionSteps {
 public:
  explicit PositionSteps(double sample_rate_hz);
  /// Learns from the first `count` of the positions; kAhead more show how they go on, where there are so
  /// many.
  void add(std::span<const double> position_m, std::size_t count);
  static constexpr std::size_t kAhead = 32;

  /// The smallest change from one step to the next, above rounding (1e-12 of `furthest_m`, the largest
  /// position). 0 where over 99 % of the steps of the moving finger are equal.
  double quantum_m(double furthest_m) const;
  /// From fourth differences, in which the finger's own motion all but cancels (under 10 nm at 3 Hz and 40
  /// mm), over up to 1 ms, so that noise after a low-pass is seen too: median / 0.6745 / sqrt(70), exact for
  /// white Gaussian noise. 0 where it is not above `quantum_m`, whose rounding
  /// looks the same, nor above the rounding of doubles.
  double noise_m(double quantum_m, double furthest_m) const;

 private:
  static constexpr std::array<std::size_t, 4> kLags = {1, 2, 4, 8};
  double sample_rate_hz_;
  LogHistogram steps_, changes_;
  std::array<LogHistogram, kLags.size()> bends_;
};

/// `pieces` lie between gaps, `furthest_m` is the largest |position|. Reads all twice. Errors: of reading.
schema::Result<PositionFacts> position_facts(const ReadFrames& read, std::span<const FrameRange> pieces,
                                             double sample_rate_hz, double furthest_m);

}  // namespace tacto::spatial

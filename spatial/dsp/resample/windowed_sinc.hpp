// SPDX-License-Identifier: GPL-3.0-or-later
// Band-limited interpolation of evenly spaced samples: the sum over sinc(t - n) under a Kaiser window (Smith,
// "Digital Audio Resampling", 1984).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// 32 samples around each place, with a window for -100 dB. Error re the amplitude of a tone: below 1e-6 up
/// to 0.3 of the sample rate, 1e-5 at 0.4; above that the gain falls (windowed_sinc_test). A constant is
/// reproduced exactly.
class WindowedSinc {
 public:
  /// Samples that are used on each side; beyond the record's ends the end's value continues.
  static constexpr std::size_t kReach = 16;

  WindowedSinc();
  /// The value at `place`, counted in samples from values[0]; at least 1 value.
  double operator()(std::span<const double> values, double place) const;

 private:
  // Row p holds the weights of the samples around a place that is p / kPhases after a sample.
  static constexpr std::size_t kTaps = 2 * kReach, kPhases = 512;
  std::vector<double> weights_;
};

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// Halving and doubling of a sample rate by half-band filters (Crochiere and Rabiner, "Multirate Digital
// Signal Processing", 1983), fed in frames.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// A symmetric low-pass at a quarter of the higher rate: 1/2 in its middle, 0 at every other even place, c_k
/// at the distance 2k + 1 on both sides. Windowed sinc (Kaiser); 1 at 0 Hz, 0 at half the higher rate.
class HalfBand {
 public:
  /// Passes up to `passed` and stops from 1/2 - passed on, in cycles per sample of the higher rate, 0 <
  /// passed < 1/4; both to `error`.
  HalfBand(double passed, double error);
  std::span<const double> taps() const { return taps_; }
  std::size_t size() const { return taps_.size(); }

 private:
  std::vector<double> taps_;
};

/// Half as many values as go in. Value j belongs to what went in as value 2 (j - delay()).
class Halver {
 public:
  explicit Halver(HalfBand filter);
  std::size_t delay() const { return filter_.size() - 1; }
  /// An even number of values in, half as many out; before the first there were zeros.
  void run(std::span<const double> in, std::span<double> out);
  void reset();

 private:
  HalfBand filter_;
  std::vector<double> even_, odd_;  // what is remembered, then the frame's
};

/// Twice as many values as go in. Value 2 (j + delay()) belongs to what went in as value j.
class Doubler {
 public:
  explicit Doubler(HalfBand filter);
  std::size_t delay() const { return filter_.size(); }
  /// Twice as many values out; before the first there were zeros.
  void run(std::span<const double> in, std::span<double> out);
  void reset();

 private:
  HalfBand filter_;
  std::vector<double> values_, between_;
};

}  // namespace tacto::spatial

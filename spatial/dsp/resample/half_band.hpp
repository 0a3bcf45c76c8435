// SPDX-License-Identifier: GPL-3.0-or-later
// Halving and doubling of a sample rate by half-band filters (Crochiere and Rabiner, "Multirate Digital
// Signal Processing", 1983), in frames.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// A symmetric low-pass at a quarter of the higher rate: its middle tap is 1/2, all other even taps are 0,
/// and the taps at distance 2k + 1 on both sides are c_k. Windowed sinc (Kaiser); 1 at 0 Hz, 0 at half the
/// higher rate.
class HalfBand {
 public:
  /// Passes up to `passed` and stops from 1/2 - passed on, in cycles per sample of the higher rate, 0 <
  /// passed < 1/4; both to within `error`.
  HalfBand(double passed, double error);
  std::span<const double> taps() const { return taps_; }
  std::size_t size() const { return taps_.size(); }

 private:
  std::vector<double> taps_;
};

/// Halves the rate. Output value j belongs to input value 2 (j - delay()).
class Halver {
 public:
  explicit Halver(HalfBand filter);
  std::size_t delay() const { return filter_.size() - 1; }
  /// An even number of values in, half as many out; the input before the first call is zero.
  void run(std::span<const double> in, std::span<double> out);
  void reset();

 private:
  HalfBand filter_;
  std::vector<double> even_, odd_;  // history, then the current frame
};

/// Doubles the rate. Output value 2 (j + delay()) belongs to input value j.
class Doubler {
 public:
  explicit Doubler(HalfBand filter);
  std::size_t delay() const { return filter_.size(); }
  /// Twice as many values out as in; the input before the first call is zero.
  void run(std::span<const double> in, std::span<double> out);
  void reset();

 private:
  HalfBand filter_;
  std::vector<double> values_, between_;
};

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// A chain of half-band filters down to the lowest rate that is sufficient for a band, and back up.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// A symmetric low-pass at a quarter of the higher rate: its middle tap is 1/2, all other even taps are 0,
/// and the taps at distance 2k + 1 on both sides are c_k. Windowed sinc (Kaiser); 1 at 0 Hz, 0 at half the
/// higher rate (Crochiere and Rabiner, "Multirate Digital Signal Processing", 1983).
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

/// In each stage the gain in the band and the aliasing into it are accurate to 1e-8.
class RateChain {
 public:
  /// Halves the rate while it stays at least 2.5 times `highest_hz`; possibly not at all.
  RateChain(double sample_rate_hz, double highest_hz);

  /// The higher rate over the lower one.
  std::size_t factor() const { return std::size_t{1} << halvers_.size(); }
  /// Delay of going down and up, in samples of the higher rate.
  std::size_t delay() const;
  /// Samples of the higher rate after which an input has no influence.
  std::size_t memory() const;

  /// Input: a multiple of factor() values; output: one for each factor() of them, valid until the next
  /// down().
  std::span<const double> down(std::span<const double> values);
  /// factor() values for each input value; valid until the next up().
  std::span<const double> up(std::span<const double> values);
  void reset();

 private:
  std::vector<Halver> halvers_;
  std::vector<Doubler> doublers_;  // doublers_[i] is the inverse of halvers_[i]
  // Two buffers each, used alternately. The output of down() is still read while up() runs.
  std::vector<double> lower_, lower_next_, upper_, upper_next_;
};

}  // namespace tacto::spatial

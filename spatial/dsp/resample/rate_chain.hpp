// SPDX-License-Identifier: GPL-3.0-or-later
// A chain of half-band filters down to the lowest rate that is sufficient for a band, and back up.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "spatial/dsp/resample/half_band.hpp"

namespace tacto::spatial {

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

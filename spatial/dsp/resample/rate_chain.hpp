// SPDX-License-Identifier: GPL-3.0-or-later
// A chain of half-band filters down to the lowest rate that still holds a band, and back up.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "spatial/dsp/resample/half_band.hpp"

namespace tacto::spatial {

/// Each stage passes the band, and folds nothing into it, to 1e-8.
class RateChain {
 public:
  /// Halves the rate while it stays at least 2.5 times `highest_hz`; not at all where it cannot.
  RateChain(double sample_rate_hz, double highest_hz);

  /// The lower rate is the higher one over this.
  std::size_t factor() const { return std::size_t{1} << halvers_.size(); }
  /// Samples of the higher rate by which going down and up is late.
  std::size_t delay() const;
  /// Samples of the higher rate after which nothing is remembered.
  std::size_t memory() const;

  /// A whole number of factor() values in, one for each of them out; valid until down() is called again.
  std::span<const double> down(std::span<const double> values);
  /// factor() values for each; valid until up() is called again.
  std::span<const double> up(std::span<const double> values);
  void reset();

 private:
  std::vector<Halver> halvers_;
  std::vector<Doubler> doublers_;  // doublers_[i] undoes halvers_[i]
  // Two of each in turn. What came down is still read while other values go up.
  std::vector<double> lower_, lower_next_, upper_, upper_next_;
};

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// The Fourier band-pass with treated ends by its definition, in extended precision.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "spatial/dsp/filter/band.hpp"

namespace tacto::spatial::reference {

// Truncation of the Fourier transform by its definition, in extended precision.

/// The result of fourier_filter with Edges::none and no gain: each frequency of the record that is in the
/// band, summed directly. Cost: size x (frequencies in the band) steps, so for records of some thousand
/// samples.
std::vector<double> exact_band_pass(std::span<const double> values, double sample_rate_hz, Band band);

/// The filter of BlockFourierFilter, summed directly at the record's own rate: the record continues beyond
/// its ends for 8 periods of `lowest_hz` (mirrored about a baseline over 2 periods, tapered to the end's
/// level), then at a constant level; the kernel ends at `reach_s`. Each value costs 2 reach_s sample_rate_hz
/// steps.
class ExactTreatedBandPass {
 public:
  ExactTreatedBandPass(std::span<const double> values, double sample_rate_hz, Band band, double lowest_hz,
                       double reach_s);
  double operator()(std::size_t index) const;

 private:
  std::vector<long double> kernel_;    // taps 0, 1, ...
  std::vector<long double> extended_;  // constant beyond its ends
  std::size_t padding_;
};

}  // namespace tacto::spatial::reference

// SPDX-License-Identifier: GPL-3.0-or-later
// The band-pass of a stretch without gaps, fed and given chunk by chunk.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "spatial/time_filter.hpp"

namespace tacto::spatial {

/// Takes a stretch's values in order and gives as many filtered ones, later. Not shared between threads.
class StreamFilter {
 public:
  virtual ~StreamFilter() = default;
  /// Appends to `out` what is known by now.
  virtual void push(std::span<const double> values, std::vector<double>& out) = 0;
  /// After the last values, once: appends all that is left.
  virtual void finish(std::vector<double>& out) = 0;
};

/// What filter_in_time() does, in bounded memory (but for Edges::none of the Fourier filter, which has to see
/// the whole stretch). Error against filter_in_time(): 1e-4 of the RMS at most. `frames` is the stretch's
/// length. Precondition: check(filter, sample_rate_hz).
std::unique_ptr<StreamFilter> stream_filter(const TimeFilter& filter, double sample_rate_hz,
                                            const SpectralGain& equaliser, std::size_t frames);

}  // namespace tacto::spatial

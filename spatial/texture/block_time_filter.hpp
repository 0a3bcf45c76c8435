// SPDX-License-Identifier: GPL-3.0-or-later
// The band-pass of a section of any length, fed in chunks: the result of filter_in_time() in bounded memory.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::spatial {

/// Input in chunks of any size; filtered values follow in order with a lag, and after finish() as many have
/// been returned as were fed. The sizes of the chunks do not change a single bit. One section without gaps at
/// a time; after finish() the next may begin. Lag and memory: of BlockFourierFilter and BlockZeroPhase (15 to
/// 500 Hz at 10 kHz: 39 s and 10 MB, or 8 s and 5 MB); FilterMethod::none without an equaliser has no lag.
/// Plain truncation (Edges::none with FilterMethod::fourier, or with an equaliser) transforms the whole
/// section, so it holds all of it until finish(). Not shared between threads.
class BlockTimeFilter {
 public:
  /// Precondition: no section has more than `longest` values; short sections then need less memory. Errors:
  /// of check().
  static schema::Result<BlockTimeFilter> open(double sample_rate_hz, const TimeFilter& filter,
                                              const SpectralGain& equaliser = {},
                                              std::size_t longest = static_cast<std::size_t>(-1));
  BlockTimeFilter(BlockTimeFilter&&) noexcept;
  BlockTimeFilter& operator=(BlockTimeFilter&&) noexcept;
  ~BlockTimeFilter();

  /// Continues the section with `values` and appends to `out` what is ready. Errors: unsuitable, for a value
  /// that is not a finite number, with its index in the section; the section is then discarded.
  schema::Result<void> push(std::span<const double> values, std::vector<double>& out);
  /// Ends the section and appends the rest of it.
  void finish(std::vector<double>& out);

  /// One of several filters in series.
  class Stage;

 private:
  explicit BlockTimeFilter(std::vector<std::unique_ptr<Stage>> stages);
  void reset();
  std::vector<std::unique_ptr<Stage>> stages_;
  std::vector<double> between_, next_;  // output of one stage, input of the next
  std::size_t taken_ = 0;
};

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// The band-pass of a stretch of any length, fed in chunks: what filter_in_time() gives, in bounded memory.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::spatial {

/// Values go in in chunks of any size, filtered values come out in order, later, and as many as went in once
/// finish() was called. The chunks' sizes change nothing, not a bit. One stretch without gaps at a time;
/// after finish() the next may begin. Lag and memory: of BlockFourierFilter and BlockZeroPhase (15 to 500 Hz
/// at 10 kHz: 39 s and 10 MB, or 8 s and 5 MB); FilterMethod::none without an equaliser does not lag. The
/// plain truncation (Edges::none with FilterMethod::fourier, or with an equaliser) is the transform of the
/// whole stretch: it holds all of it until finish(). Not shared between threads.
class BlockTimeFilter {
 public:
  /// `longest` is a promise that no stretch has more values: short ones are then filtered in little memory.
  /// Errors: of check().
  static schema::Result<BlockTimeFilter> open(double sample_rate_hz, const TimeFilter& filter,
                                              const SpectralGain& equaliser = {},
                                              std::size_t longest = static_cast<std::size_t>(-1));
  BlockTimeFilter(BlockTimeFilter&&) noexcept;
  BlockTimeFilter& operator=(BlockTimeFilter&&) noexcept;
  ~BlockTimeFilter();

  /// The stretch goes on with `values`; appends to `out` what is ready. Errors: unsuitable, for a value that
  /// is not a finite number, by its index in the stretch; the stretch is then dropped.
  schema::Result<void> push(std::span<const double> values, std::vector<double>& out);
  /// The stretch ends; appends what is left of it.
  void finish(std::vector<double>& out);

  /// One filter of several that values go through in turn.
  class Stage;

 private:
  explicit BlockTimeFilter(std::vector<std::unique_ptr<Stage>> stages);
  void reset();
  std::vector<std::unique_ptr<Stage>> stages_;
  std::vector<double> between_, next_;  // what one stage gave to the next
  std::size_t taken_ = 0;
};

}  // namespace tacto::spatial

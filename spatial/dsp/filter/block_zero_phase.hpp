// SPDX-License-Identifier: GPL-3.0-or-later
// filter_zero_phase() of a record of any length, fed in chunks.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "spatial/dsp/filter/sections.hpp"

namespace tacto::spatial {

/// Runs forwards as values arrive, and backwards over blocks. Each backward run begins so far beyond its
/// block that the influence of later values has decayed to 1e-15: for order 4 from 15 Hz at 10 kHz, 1.4 s.
/// Error against filter_zero_phase(): 1e-13 of the largest value (block_zero_phase_test). Chunks may have any
/// size, which does not change a single bit. Lag and memory: that time and a block of four times as much, or
/// of 65536 samples if that is more. Not shared between threads.
class BlockZeroPhase {
 public:
  /// `padding` as in filter_zero_phase().
  BlockZeroPhase(std::span<const Section> sections, std::size_t padding);

  /// Continues the record and appends to `out` the filtered values that are ready, in order.
  void push(std::span<const double> values, std::vector<double>& out);
  /// Ends the record and appends the rest. The next one may begin.
  void finish(std::vector<double>& out);
  /// Discards the current record.
  void reset();

 private:
  void begin(std::size_t padding);
  void append(std::span<const double> values);
  void run_block(std::size_t size, std::size_t seen, std::vector<double>& out);

  SectionChain forwards_, backwards_;
  std::size_t most_padding_, fading_, block_;
  std::vector<double> held_;   // the record's last values; all of them until it has begun
  std::vector<double> ahead_;  // run forwards, not yet backwards
  std::vector<double> scratch_;
  std::size_t padding_ = 0, to_skip_ = 0;
  bool begun_ = false;
};

}  // namespace tacto::spatial

// SPDX-License-Identifier: GPL-3.0-or-later
// filter_zero_phase() of a record of any length, fed in chunks.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "spatial/dsp/filter/sections.hpp"

namespace tacto::spatial {

/// Runs forwards as values come, and backwards over blocks, each begun so far beyond its end that what it did
/// not see has faded to 1e-15: for order 4 from 15 Hz at 10 kHz, 1.4 s. Error against filter_zero_phase():
/// 1e-13 of the largest value (block_zero_phase_test). Chunks may have any size and change nothing, not a
/// bit. Lag and memory: that time and a block of four times as much, or 65536 samples if that is more. Not
/// shared between threads.
class BlockZeroPhase {
 public:
  /// `padding` as filter_zero_phase() takes it.
  BlockZeroPhase(std::span<const Section> sections, std::size_t padding);

  /// The record goes on; appends to `out` the filtered values that are known, in order.
  void push(std::span<const double> values, std::vector<double>& out);
  /// The record ends: appends the rest. The next may begin.
  void finish(std::vector<double>& out);
  /// Forgets the record that was begun.
  void reset();

 private:
  void begin(std::size_t padding);
  void append(std::span<const double> values);
  void run_block(std::size_t size, std::size_t seen, std::vector<double>& out);

  SectionChain forwards_, backwards_;
  std::size_t most_padding_, fading_, block_;
  std::vector<double> held_;   // the record's last values; until it has begun, all of them
  std::vector<double> ahead_;  // run forwards, not yet backwards
  std::vector<double> scratch_;
  std::size_t padding_ = 0, to_skip_ = 0;
  bool begun_ = false;
};

}  // namespace tacto::spatial

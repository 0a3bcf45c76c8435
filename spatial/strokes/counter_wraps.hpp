// SPDX-License-Identifier: GPL-3.0-or-later
// Overflows of counters of 16, 24 or 32 bits: the frame of each, and the counts to add from there on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "data-schema/recording/recording.hpp"

namespace tacto::spatial {

/// From `frame` on, `turns` x 2^bits counts are added to the stored value.
struct CounterTurn {
  std::size_t frame = 0;
  int turns = 0;
};

/// The wraps of a counter, sorted by frame; `bits` is 0 if it never wrapped.
struct CounterWraps {
  int bits = 0;
  std::vector<CounterTurn> turns;
  /// Adds the missing counts to values that begin at frame `first`.
  void unwrap(std::size_t first, std::span<double> counts) const;
  /// Number of wraps within [begin, end).
  std::size_t count_in(std::size_t begin, std::size_t end) const;
};

/// Finds wraps in the stored numbers of a record, which are added in order. A wrap is a step of 2^16, 2^24 or
/// 2^32 whole counts within a tolerance that follows from the finger's steps before and after it: twice the
/// larger one and 16 counts, over a gap multiplied by its missing frames. The whole record must span fewer
/// counts than that. A counter that was set to 0 by hand is not a wrap, nor is a jump between numbers that
/// are not whole.
class CounterWrapFinder {
 public:
  explicit CounterWrapFinder(std::span<const schema::Gap> gaps) : gaps_(gaps) {}
  void add(std::span<const double> counts);
  /// After the last add(), once.
  CounterWraps finish();
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

 private:
  // Tests a step of counts into frame `frame`; `before` and `after` are the steps on both sides.
  void judge(double before, double step, double after, std::size_t frame);
  std::uint64_t missing_before(std::size_t frame) const;

  std::span<const schema::Gap> gaps_;
  std::array<std::vector<CounterTurn>, 3> found_;  // of 16, 24, 32 bits
  double lowest_ = 0, highest_ = 0;
  double value_ = 0, step_ = 0, step_before_ = 0;
  std::size_t frames_ = 0;
};

}  // namespace tacto::spatial

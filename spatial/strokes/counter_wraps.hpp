// SPDX-License-Identifier: GPL-3.0-or-later
// Counters of 16, 24 or 32 bits that ran over: where, and how many counts to add from there on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "data-schema/recording/recording.hpp"

namespace tacto::spatial {

/// From `frame` on `turns` x 2^bits counts are added to what is stored.
struct CounterTurn {
  std::size_t frame = 0;
  int turns = 0;
};

/// The wraps of a counter, by frame; `bits` is 0 where it never wrapped.
struct CounterWraps {
  int bits = 0;
  std::vector<CounterTurn> turns;
  /// What to add to the counts of values that begin at frame `first`.
  void unwrap(std::size_t first, std::span<double> counts) const;
  /// How often it wrapped within [begin, end).
  std::size_t count_in(std::size_t begin, std::size_t end) const;
};

/// Finds wraps in stored numbers that come in order. A wrap is a step that misses 2^16, 2^24 or 2^32 whole
/// counts by no more than what the finger's steps before and after it tell (twice the larger one, and 16
/// counts; over a gap times its missing frames), in a record that nowhere spans as many counts. A counter
/// that was set to 0 by hand is none, nor is a jump of numbers that are no whole counts.
class CounterWrapFinder {
 public:
  explicit CounterWrapFinder(std::span<const schema::Gap> gaps) : gaps_(gaps) {}
  void add(std::span<const double> counts);
  /// After the last of them, once.
  CounterWraps finish();
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

 private:
  // A step of counts into frame `frame`, with the steps on both sides known.
  void judge(double before, double step, double after, std::size_t frame);
  std::uint64_t missing_before(std::size_t frame) const;

  std::span<const schema::Gap> gaps_;
  std::array<std::vector<CounterTurn>, 3> found_;  // of 16, 24, 32 bits
  double lowest_ = 0, highest_ = 0;
  double value_ = 0, step_ = 0, step_before_ = 0;
  std::size_t frames_ = 0;
};

}  // namespace tacto::spatial

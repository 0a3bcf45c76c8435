// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/counter_wraps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tacto::spatial {
namespace {

constexpr std::array<int, 3> kBits = {16, 24, 32};
constexpr double kStepsOff = 2;    // a finger does not double its speed within a sample
constexpr double kCountsOff = 16;  // dither of a resting encoder, and a start from rest
constexpr double kSmallestJump = 0x1p15;

double turn_of(int bits) {
  return std::ldexp(1.0, bits);
}

bool is_whole(double value) {
  return value == std::round(value);
}

}  // namespace

void CounterWraps::unwrap(std::size_t first, std::span<double> counts) const {
  if (bits == 0) return;
  auto next = std::ranges::upper_bound(turns, first, {}, &CounterTurn::frame);
  double added = next == turns.begin() ? 0 : std::prev(next)->turns * turn_of(bits);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (; next != turns.end() && next->frame <= first + i; ++next) added = next->turns * turn_of(bits);
    counts[i] += added;
  }
}

std::size_t CounterWraps::count_in(std::size_t begin, std::size_t end) const {
  const auto first = std::ranges::upper_bound(turns, begin, {}, &CounterTurn::frame);
  const auto last = std::ranges::lower_bound(first, turns.end(), end, {}, &CounterTurn::frame);
  return static_cast<std::size_t>(last - first);
}

std::uint64_t CounterWrapFinder::missing_before(std::size_t frame) const {
  std::uint64_t missing = 0;
  for (const schema::Gap& gap : std::ranges::equal_range(gaps_, frame, {}, &schema::Gap::frame))
    missing += gap.count;
  return missing;
}

void CounterWrapFinder::judge(double before, double step, double after, std::size_t frame) {
  const double around = std::max(std::abs(before), std::abs(after));
  const double off = kStepsOff * around * static_cast<double>(1 + missing_before(frame)) + kCountsOff;
  for (std::size_t b = 0; b < kBits.size(); ++b) {
    const double turn = turn_of(kBits[b]), missed = std::abs(step) - turn;
    if (std::abs(missed) > std::min(off, turn / 4) || !is_whole(step)) continue;
    auto& turns = found_[b];
    const int so_far = turns.empty() ? 0 : turns.back().turns;
    turns.push_back({frame, so_far + (step < 0 ? 1 : -1)});
  }
}

void CounterWrapFinder::add(std::span<const double> counts) {
  for (const double value : counts) {
    if (frames_ == 0) lowest_ = highest_ = value_ = value;
    const double step = value - value_;
    if (std::abs(step_) > kSmallestJump) judge(step_before_, step_, step, frames_ - 1);
    lowest_ = std::min(lowest_, value);
    highest_ = std::max(highest_, value);
    step_before_ = std::exchange(step_, step);
    value_ = value;
    ++frames_;
  }
}

CounterWraps CounterWrapFinder::finish() {
  if (std::abs(step_) > kSmallestJump) judge(step_before_, step_, 0, frames_ - 1);
  for (std::size_t b = 0; b < kBits.size(); ++b)
    if (!found_[b].empty() && highest_ - lowest_ < turn_of(kBits[b])) return {kBits[b], found_[b]};
  return {};
}

}  // namespace tacto::spatial

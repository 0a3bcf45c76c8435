// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/edge_speed.hpp"

#include "firmware-host/core/kernel/counts_between.hpp"

namespace tacto::core {
namespace {

// Counts per ticks; ticks are above 0. Products of 32 bits each are one instruction.
struct Slope {
  int32_t counts, ticks;
  bool below(const Slope& other) const noexcept {
    return int64_t{counts} * other.ticks < int64_t{other.counts} * ticks;
  }
};

// A count more or less does not overflow; no hand moves so far between two edges.
int32_t bounded(int32_t counts) noexcept {
  constexpr int32_t kMost = INT32_C(0x7FFFFFFE);
  return counts > kMost ? kMost : counts < -kMost ? -kMost : counts;
}

// The slopes of all lines through the last edge that pass within 1 count of the points seen so far.
struct SlopeRange {
  Slope low, high;
  void pass(const Slope& point) noexcept {
    const Slope least{point.counts - 1, point.ticks}, most{point.counts + 1, point.ticks};
    if (low.below(least)) low = least;
    if (most.below(high)) high = most;
  }
  bool holds(const Slope& slope) const noexcept { return !slope.below(low) && !high.below(slope); }
};

int32_t sign_of(int32_t moved) noexcept {
  return moved > 0 ? 1 : moved < 0 ? -1 : 0;
}

}  // namespace

void EdgeSpeed::begin(uint32_t tick, int32_t count) noexcept {
  kept_ = 1;
  edges_[newest_] = {tick, count};
}

void EdgeSpeed::add(int32_t count) noexcept {
  newest_ = (newest_ + 1) % kSpeedEdges;
  edges_[newest_] = {tick_, count};
  if (kept_ < kSpeedEdges) ++kept_;
}

// A count stays until the tick before the next edge: that point is one that the line has to pass, too.
float EdgeSpeed::slope() const noexcept {
  const Edge& last = edge(0);
  const auto to_last = [&](uint32_t tick, int32_t count) noexcept {
    return Slope{bounded(counts_between(count, last.count)), static_cast<int32_t>(last.tick - tick)};
  };
  const Slope step = to_last(last.tick - 1, edge(1).count);
  Slope best = step;
  SlopeRange range{{step.counts - 1, 1}, {step.counts + 1, 1}};
  for (uint32_t back = 1; back < kept_; ++back) {
    const Slope here = to_last(edge(back).tick, edge(back).count);
    if (here.ticks > static_cast<int32_t>(kLongestSpeedTicks) || !range.holds(here)) break;
    best = here;
    range.pass(here);
    if (back + 1 < kept_) range.pass(to_last(edge(back).tick - 1, edge(back + 1).count));
  }
  return static_cast<float>(best.counts) / static_cast<float>(best.ticks);
}

void EdgeSpeed::stay() noexcept {
  const uint32_t since = tick_ - edge(0).tick;
  if (since >= kLongestSpeedTicks) {
    begin(tick_ - kLongestSpeedTicks, count_);
    way_ = 0;
    speed_ = 0;
    return;
  }
  const float most = 1 / static_cast<float>(since);
  speed_ = speed_ > most ? most : speed_ < -most ? -most : speed_;
}

float EdgeSpeed::track(int32_t count) noexcept {
  ++tick_;
  if (kept_ == 0) {
    begin(tick_, count);
    count_ = count;
    way_ = 0;
    return speed_ = 0;
  }
  const int32_t moved = counts_between(count_, count);
  if (moved == 0) {
    stay();
    return speed_;
  }
  const int32_t way = sign_of(moved);
  const bool turned = way * way_ < 0;
  if (turned) begin(tick_ - 1, count_);
  add(count);
  const bool same_border = (turned || way_ == 0) && moved == way;
  if (same_border) begin(tick_, count);
  speed_ = same_border ? 0 : slope();
  count_ = count;
  way_ = way;
  return speed_;
}

}  // namespace tacto::core

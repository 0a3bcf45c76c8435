// SPDX-License-Identifier: Apache-2.0
// Estimates the speed of a hand from the times at which an encoder's count changes.
#pragma once

#include <stdint.h>

namespace tacto::core {

inline constexpr uint32_t kSpeedEdges = 16;
inline constexpr uint32_t kLongestSpeedTicks = UINT32_C(1) << 20;  ///< a slower hand is at rest

/// The slope of a straight line between two edges (ticks at which the count changed): from the last edge back
/// to the oldest of kSpeedEdges edges for which every count in between is within 1 count of the line (the
/// adaptive window of Janabi-Sharifi, Hayward and Chen 2000, over edges instead of samples). A hand that
/// accelerates so that a count differs from the line by more shortens the window, down to the difference of
/// two ticks. Between edges the speed is at most 1 count / time since the last edge. An edge of one count
/// against the last direction is the same border crossed twice: then the speed is 0. So it is at the first
/// edge of one count after a rest, because the hand may have been beside the border.
/// At constant speed the error is below 1 count / (ticks of the window): relative to the speed, below 1 / 15
/// from one count per tick on and below that at lower speeds; a difference of two ticks has 1 count per tick.
/// The slope is that of the middle of the window. All comparisons are exact, in whole numbers.
class EdgeSpeed {
 public:
  void rest() noexcept { kept_ = 0; }
  /// Counts per tick at this tick; once a tick. Safe in the tick: at most kSpeedEdges steps.
  float track(int32_t count) noexcept;

 private:
  struct Edge {
    uint32_t tick = 0;
    int32_t count = 0;
  };
  void begin(uint32_t tick, int32_t count) noexcept;
  void add(int32_t count) noexcept;
  void stay() noexcept;
  float slope() const noexcept;
  const Edge& edge(uint32_t back) const noexcept { return edges_[(newest_ - back) % kSpeedEdges]; }

  Edge edges_[kSpeedEdges];
  uint32_t kept_ = 0, newest_ = 0, tick_ = 0;
  int32_t count_ = 0;
  int32_t way_ = 0;  // of the last edge: -1, 0, 1
  float speed_ = 0;
};

}  // namespace tacto::core

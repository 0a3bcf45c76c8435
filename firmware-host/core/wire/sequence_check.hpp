// SPDX-License-Identifier: Apache-2.0
// Finds missing and repeated frames.
#pragma once

#include <stdint.h>

namespace tacto::wire {

enum class Order : uint8_t {
  expected,
  gap,    ///< frames before it are missing
  stale,  ///< it, or a later one, was received before: ignore it
};

/// Sequence numbers increase by one per frame and wrap at 2^32. Differences up to 2^31 are forwards.
class SequenceCheck {
 public:
  /// The next frame may have any number: a new connection.
  void expect_any() noexcept { any_ = true; }
  Order check(uint32_t sequence) noexcept {
    const uint32_t ahead = any_ ? 0 : sequence - next_;
    if (ahead > UINT32_C(0x7FFFFFFF)) {
      ++stale_;
      return Order::stale;
    }
    any_ = false;
    next_ = sequence + 1;
    lost_ += ahead;
    return ahead > 0 ? Order::gap : Order::expected;
  }
  uint32_t lost() const noexcept { return lost_; }
  uint32_t stale() const noexcept { return stale_; }

 private:
  uint32_t next_ = 0, lost_ = 0, stale_ = 0;
  bool any_ = true;
};

}  // namespace tacto::wire

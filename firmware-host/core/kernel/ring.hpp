// SPDX-License-Identifier: Apache-2.0
// A queue between the tick and the main loop.
#pragma once

#include "firmware-host/core/kernel/shared.hpp"

namespace tacto::core {

/// One side writes, the other reads; neither waits. kSize is a power of two. Only the reader calls clear(),
/// while the writer is inactive or may lose its latest items. Safe in the tick.
template <class T, uint32_t kSize>
class Ring {
  static_assert((kSize & (kSize - 1)) == 0);

 public:
  /// The place to fill next, or null if the ring is full. It is part of the ring after push().
  T* place() noexcept {
    const uint32_t head = head_.load();
    return head - tail_.load() < kSize ? &items_[head % kSize] : nullptr;
  }
  void push() noexcept { head_.store(head_.load() + 1); }

  /// The oldest item, or null if the ring is empty.
  const T* front() const noexcept {
    const uint32_t tail = tail_.load();
    return tail != head_.load() ? &items_[tail % kSize] : nullptr;
  }
  void pop() noexcept { tail_.store(tail_.load() + 1); }
  void clear() noexcept { tail_.store(head_.load()); }
  uint32_t size() const noexcept { return head_.load() - tail_.load(); }

 private:
  T items_[kSize];
  Shared<uint32_t> head_, tail_;
};

}  // namespace tacto::core

// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes from one thread to another, without a lock.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tacto::playback {

/// For one writing thread and one reading thread; neither waits. Safe in the tick.
template <std::size_t kSize>
class ByteRing {
  static_assert((kSize & (kSize - 1)) == 0);

 public:
  /// Returns how many bytes had space.
  std::size_t put(std::span<const std::uint8_t> bytes) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    const std::size_t room = kSize - (head - tail_.load(std::memory_order_acquire));
    const std::size_t count = std::min(room, bytes.size());
    for (std::size_t i = 0; i < count; ++i) bytes_[(head + i) % kSize] = bytes[i];
    head_.store(head + count, std::memory_order_release);
    return count;
  }
  std::size_t take(std::span<std::uint8_t> bytes) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t count = std::min(head_.load(std::memory_order_acquire) - tail, bytes.size());
    for (std::size_t i = 0; i < count; ++i) bytes[i] = bytes_[(tail + i) % kSize];
    tail_.store(tail + count, std::memory_order_release);
    return count;
  }

 private:
  std::array<std::uint8_t, kSize> bytes_{};
  std::atomic<std::size_t> head_{0}, tail_{0};
};

}  // namespace tacto::playback

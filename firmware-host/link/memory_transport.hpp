// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes between a client and a core that a real-time thread of this process runs.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "firmware-host/link/tick_clock.hpp"
#include "firmware-host/link/transport.hpp"

namespace tacto::firmware_host {

/// Bytes from one thread to another, without a lock. For one writing thread and one reading thread; neither
/// waits. Safe in the tick.
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

/// Both directions.
struct CoreLink {
  ByteRing<65536> to_core;
  ByteRing<262144> from_core;
};

/// The client's end. The link must outlive it.
class MemoryTransport : public Transport {
 public:
  MemoryTransport(CoreLink& link, std::string where) : link_(link), where_(std::move(where)) {}

  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    for (const double end_s = now_s() + timeout_s;;) {
      if (const std::size_t got = link_.from_core.take(bytes); got > 0) return got;
      if (now_s() >= end_s) return std::size_t{0};
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) override {
    for (const double end_s = now_s() + timeout_s; !bytes.empty();) {
      bytes = bytes.subspan(link_.to_core.put(bytes));
      if (!bytes.empty() && now_s() >= end_s)
        return schema::fail(schema::ErrorKind::device, "the real-time thread accepts no data", where_);
      if (!bytes.empty()) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return {};
  }
  double now_s() override { return 1e-9 * static_cast<double>(TickClock::now_ns()); }

 private:
  CoreLink& link_;
  std::string where_;
};

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// The device's end of the cable: bytes to and from the host.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

namespace tacto::firmware_host {

// A queue of bytes to the host.

struct Burst {
  std::vector<std::uint8_t> bytes;
  bool last = false;  ///< the queue is empty after it
};

/// One thread writes, another reads.
class BurstQueue {
 public:
  void put(std::span<const std::uint8_t> bytes);
  /// The next bytes, at most `most`; empty if nothing arrives within `wait`.
  Burst take(std::size_t most, std::chrono::milliseconds wait);
  void clear();
  std::size_t waiting() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::deque<std::uint8_t> bytes_;
};

/// For the thread of the board; none of the calls but wait_until() waits.
class BoardLink {
 public:
  using Clock = std::chrono::steady_clock;
  virtual ~BoardLink() = default;

  virtual void send(std::span<const std::uint8_t> bytes) = 0;
  /// The number of bytes that the cable has not taken yet.
  virtual std::size_t waiting() const = 0;
  /// Appends the received bytes.
  virtual void take_received(std::vector<std::uint8_t>& bytes) = 0;
  /// Until bytes have arrived since the last call, or until `time`.
  virtual void wait_until(Clock::time_point time) = 0;
};

}  // namespace tacto::firmware_host

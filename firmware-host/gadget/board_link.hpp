// SPDX-License-Identifier: GPL-3.0-or-later
// The device's end of the cable: bytes to and from the host.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware-host/gadget/burst_queue.hpp"

namespace tacto::firmware_host {

/// For the thread of the board; none of the calls but wait_until() waits.
class BoardLink {
 public:
  using Clock = std::chrono::steady_clock;
  virtual ~BoardLink() = default;

  virtual void send(std::span<const std::uint8_t> bytes, BurstEnd end) = 0;
  /// The number of bytes that the cable has not taken yet.
  virtual std::size_t waiting() const = 0;
  /// Appends the received bytes.
  virtual void take_received(std::vector<std::uint8_t>& bytes) = 0;
  /// Until bytes have arrived since the last call, or until `time`.
  virtual void wait_until(Clock::time_point time) = 0;
};

}  // namespace tacto::firmware_host

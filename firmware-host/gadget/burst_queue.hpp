// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes on their way to the host, with the places where something other than bytes is due.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

namespace tacto::firmware_host {

/// What follows a burst's bytes. All but `none` and `end` are faults for tests.
enum class BurstEnd : std::uint8_t {
  none,    ///< more bytes may follow in the same transfer
  end,     ///< the transfer ends here
  stall,   ///< the endpoint stalls
  unplug,  ///< the device lets go of the data line
};

struct Burst {
  std::vector<std::uint8_t> bytes;
  BurstEnd end = BurstEnd::none;
  bool last = false;  ///< nothing waits behind it
};

/// One thread puts, another takes.
class BurstQueue {
 public:
  void put(std::span<const std::uint8_t> bytes, BurstEnd end = BurstEnd::none);
  /// What waits, up to `most` bytes or the first end; empty where nothing came within `wait`.
  Burst take(std::size_t most, std::chrono::milliseconds wait);
  void clear();
  std::size_t waiting() const;

 private:
  struct End {
    std::uint64_t at = 0;  // bytes ever put before it
    BurstEnd end = BurstEnd::none;
  };
  bool something() const { return !bytes_.empty() || !ends_.empty(); }

  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::deque<std::uint8_t> bytes_;
  std::deque<End> ends_;
  std::uint64_t put_ = 0, taken_ = 0;
};

}  // namespace tacto::firmware_host

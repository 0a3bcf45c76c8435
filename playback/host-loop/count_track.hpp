// SPDX-License-Identifier: GPL-3.0-or-later
// The encoder's counts as a device made them, read at the pace of another clock.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace tacto::playback {

/// A device hands over its counts several at a time, and its clock is not this computer's: whoever took the
/// last count each tick would feel a finger that stands and leaps. So each count keeps its period, and a tick
/// goes on by one (also after ticks that were slept through), on a line between two counts, as close behind
/// the newest one as never leaves it without (over half a second; it nears by at most 2 %, which no skin
/// tells). Beyond the newest it goes on straight for 2 ms, then it stands. Where more than 20 ms lie ahead,
/// as after a stall, it goes at once to where it begins: a reserve behind the newest. put() is for one
/// thread, the rest for another; none locks, allocates or calls the system.
class CountTrack {
 public:
  explicit CountTrack(double rate_hz) noexcept;
  /// How many periods come together, before which nothing lies ahead. Before see() and begin().
  void set_reserve(std::uint32_t periods) noexcept;
  /// In their order; periods that are left out lie on a line. `made_ns`: when the device took it.
  void put(std::uint32_t period, std::int32_t count, std::int64_t made_ns) noexcept;

  /// What a tick sees.
  struct Sight {
    std::int32_t count = 0;
    std::uint32_t passed = 0;  ///< periods since the sight before; 1 is usual
    std::int64_t made_ns = 0;
    bool fresh = false;  ///< something came since
    /// The count is that of this period and a part of the next one.
    std::uint32_t period = 0;
    float part = 0;
  };
  /// Goes on by one period.
  Sight see() noexcept;
  /// The count that a reserve lies behind the newest, from which the next see() goes on.
  Sight begin() noexcept;

 private:
  static constexpr std::uint32_t kKept = 1024;
  std::int32_t kept(std::uint32_t period) const noexcept {
    return counts_[period % kKept].load(std::memory_order_relaxed);
  }
  std::int32_t count_here(std::uint32_t newest) const noexcept;
  void keep_near(float lag) noexcept;

  std::array<std::atomic<std::int32_t>, kKept> counts_{};
  std::atomic<std::uint32_t> newest_{0};
  std::atomic<std::int64_t> newest_ns_{0};
  std::uint32_t put_ = 0;  // the putter's
  bool begun_ = false;     // the putter's
  // The taker's.
  std::int64_t period_ns_;
  std::int32_t most_behind_, most_beyond_, window_;
  std::uint32_t reserve_ = 0, at_ = 0, seen_ = 0;
  float part_ = 0, drift_ = 0, least_;
  std::int32_t in_window_ = 0;
};

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// The encoder's counts as a device made them, read at the pace of another clock.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace tacto::playback {

/// A device sends its counts in groups, and by its own clock. A tick that used the newest count would get a
/// position that stops and jumps. So each count is stored with its period, and each tick (also after missed
/// ones) advances the reading place by one period, on a line between two counts. Its lag behind the newest
/// count is the smallest with which it does not overtake that count within half a second; to reduce the lag
/// the place moves at most 2 % faster, which is not perceptible. Beyond the newest count it continues on a
/// straight line for 2 ms, then it stops. If the lag exceeds 20 ms, as after a stall, the place is set to a
/// reserve behind the newest count. One thread calls put(), another one the rest; no function locks,
/// allocates or calls the system.
class CountTrack {
 public:
  explicit CountTrack(double rate_hz) noexcept;
  /// How many periods come as one group: the lag at the beginning. Call before see() and begin().
  void set_reserve(std::uint32_t periods) noexcept;
  /// Call in the order of the periods; skipped periods are interpolated linearly. `made_ns`: when the device
  /// sampled it.
  void put(std::uint32_t period, std::int32_t count, std::int64_t made_ns) noexcept;

  /// The count that a tick uses.
  struct Sight {
    std::int32_t count = 0;
    std::uint32_t passed = 0;  ///< periods since the see() before; usually 1
    std::int64_t made_ns = 0;
    bool fresh = false;  ///< a new count came since then
    /// The place in time: this period plus a fraction of the next one.
    std::uint32_t period = 0;
    float part = 0;
  };
  /// Advances by one period.
  Sight see() noexcept;
  /// Sets the place to the reserve behind the newest count; see() continues from there.
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
  std::uint32_t put_ = 0;  // of the thread that calls put()
  bool begun_ = false;     // of the thread that calls put()
  // Of the thread that calls see().
  std::int64_t period_ns_;
  std::int32_t most_behind_, most_beyond_, window_;
  std::uint32_t reserve_ = 0, at_ = 0, seen_ = 0;
  float part_ = 0, drift_ = 0, least_;
  std::int32_t in_window_ = 0;
};

}  // namespace tacto::playback

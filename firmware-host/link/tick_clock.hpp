// SPDX-License-Identifier: GPL-3.0-or-later
// When the next tick is due: absolute time, a sleep and then a busy wait.
#pragma once

#include <time.h>

#include <cerrno>
#include <cstdint>

namespace tacto::firmware_host {

/// Periods by CLOCK_MONOTONIC, without drift. wait() sleeps until 50 us before the due time, or 40 % of the
/// period if that is less (the kernel throttles real-time threads at 95 %), and waits busily for the rest. A
/// missed period is skipped, never made up for. Safe in the tick: clock_nanosleep is its only system call.
class TickClock {
 public:
  void begin(double rate_hz) noexcept {
    period_ns_ = static_cast<std::int64_t>(1e9 / rate_hz);
    const std::int64_t part = period_ns_ * 2 / 5;
    spin_ns_ = part < kMostSpinNs ? part : kMostSpinNs;
    due_ns_ = now_ns();
    longer_ns_ = 0;
  }
  /// Waits for the next tick; returns how late it is. `missed` grows by the number of skipped periods.
  std::int64_t wait(std::uint64_t& missed) noexcept {
    due_ns_ += period_ns_ + longer_ns_;
    std::int64_t now = now_ns();
    if (due_ns_ - spin_ns_ > now) sleep_until(due_ns_ - spin_ns_);
    while ((now = now_ns()) < due_ns_) {
    }
    const std::int64_t late_ns = now - due_ns_;
    if (late_ns >= period_ns_) {
      missed += static_cast<std::uint64_t>(late_ns / period_ns_);
      due_ns_ += late_ns / period_ns_ * period_ns_;
    }
    return late_ns;
  }
  std::int64_t period_ns() const noexcept { return period_ns_; }
  /// Adds this to each period from now on (much less than a period), to follow another clock.
  void lengthen(std::int64_t by_ns) noexcept { longer_ns_ = by_ns; }
  static std::int64_t now_ns() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * kSecondNs + now.tv_nsec;
  }

 private:
  static constexpr std::int64_t kSecondNs = 1'000'000'000, kMostSpinNs = 50'000;
  static void sleep_until(std::int64_t ns) noexcept {
    const timespec due{ns / kSecondNs, ns % kSecondNs};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
    }
  }
  std::int64_t period_ns_ = 1, spin_ns_ = 0, due_ns_ = 0, longer_ns_ = 0;
};

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: Apache-2.0
// SysTick as the tick of a device, and as its clock.
#pragma once

#include "firmware-host/boards/shared/cortex_m.hpp"

namespace tacto::boards {

/// All on one core: interrupt() in the interrupt of SysTick, the rest where the firmware is polled.
template <uint32_t kClockHz>
class TickTimer {
 public:
  /// Since the rate was set.
  uint32_t ticks() const { return ticks_; }
  /// Of a tick.
  float period_s() const { return static_cast<float>(period_) / kClockHz; }

  /// Whether the device has to tick.
  bool interrupt() {
    ticks_ = ticks_ + 1;
    return ticking_;
  }

  uint64_t clock() const {
    uint32_t before = 0, left = 0;
    do {
      before = ticks_;
      left = syst_cvr;
    } while (before != ticks_);
    return clock_before_ + uint64_t{before} * period_ + (period_ - 1 - left);
  }

  /// Without ticks (0) SysTick wakes the main loop every millisecond, for the watchdog.
  void set_rate(uint32_t rate_millihertz) {
    syst_csr = 0;
    clock_before_ = clock();
    ticks_ = 0;
    ticking_ = rate_millihertz != 0;
    period_ = kWakingPeriod;
    // kClockHz x 1000 / rate, rounded, without a division of 64 bits: 40 x kPart.
    constexpr uint32_t kPart = kClockHz / 40 * 1000;
    static_assert(uint64_t{kPart} * 40 == uint64_t{kClockHz} * 1000);
    if (ticking_)
      period_ = kPart / rate_millihertz * 40 +
                (kPart % rate_millihertz * 40 + rate_millihertz / 2) / rate_millihertz;
    syst_rvr = period_ - 1;
    syst_cvr = 0;
    syst_csr = 7;
  }

 private:
  static constexpr uint32_t kWakingPeriod = kClockHz / 1000;
  volatile uint32_t ticks_ = 0;
  volatile bool ticking_ = false;
  uint32_t period_ = kWakingPeriod;  // in periods of the core's clock
  uint64_t clock_before_ = 0;        // when the rate was set
};

}  // namespace tacto::boards

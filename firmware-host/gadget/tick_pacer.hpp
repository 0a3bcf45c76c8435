// SPDX-License-Identifier: GPL-3.0-or-later
// Runs ticks by the wall clock.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace tacto::firmware_host {

/// Tick k is due at start + k periods, however late the process wakes: a delay costs no tick, and the rate
/// does not drift. One wake-up may run several ticks. If a board is far behind, the schedule shifts instead.
class TickPacer {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr double kWakeS = 2e-3;    ///< at most this often
  static constexpr double kBehindS = 0.05;  ///< if it is farther behind, the schedule shifts

  /// Starts the schedule at `now`.
  void start(double period_s, Clock::time_point now) {
    period_s_ = period_s;
    start_ = now;
    done_ = 0;
  }
  void stop() { period_s_ = 0; }
  bool running() const { return period_s_ > 0; }

  /// The number of ticks that are due. `slipped_s` returns the shift of the schedule, if any.
  std::uint64_t due(Clock::time_point now, double& slipped_s) {
    const double behind_s = seconds(now - start_) - static_cast<double>(done_) * period_s_;
    slipped_s = behind_s > kBehindS ? behind_s : 0;
    if (slipped_s > 0) start(period_s_, now);
    return behind_s < 0 || slipped_s > 0 ? 0 : static_cast<std::uint64_t>(behind_s / period_s_);
  }
  void did(std::uint64_t ticks) { done_ += ticks; }
  Clock::time_point next_wake(Clock::time_point now) const {
    const double next_s = static_cast<double>(done_ + 1) * period_s_;
    return std::max(start_ + duration(next_s), now + duration(kWakeS));
  }

 private:
  static double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }
  static Clock::duration duration(double time_s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
  }

  double period_s_ = 0;
  Clock::time_point start_;
  std::uint64_t done_ = 0;
};

}  // namespace tacto::firmware_host

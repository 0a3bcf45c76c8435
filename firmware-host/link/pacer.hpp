// SPDX-License-Identifier: GPL-3.0-or-later
// Emulated time that waits for the clock on the wall.
#pragma once

#include <chrono>
#include <thread>

namespace tacto::firmware_host {

/// Keeps emulated time from running ahead of real time by more than a millisecond. Where the process was held
/// up, emulated time catches up.
class Pacer {
 public:
  void wait_until(double emulated_s) const {
    if (due(emulated_s) - Clock::now() > kSlack) std::this_thread::sleep_until(due(emulated_s));
  }
  /// However short the wait.
  void sleep_until(double emulated_s) const { std::this_thread::sleep_until(due(emulated_s)); }

  /// Real time since this began.
  double now_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point due(double emulated_s) const {
    return start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(emulated_s));
  }
  static constexpr auto kSlack = std::chrono::milliseconds(1);
  Clock::time_point start_ = Clock::now();
};

}  // namespace tacto::firmware_host

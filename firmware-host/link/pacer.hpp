// SPDX-License-Identifier: GPL-3.0-or-later
// Paces emulated time by the wall clock.
#pragma once

#include <chrono>
#include <thread>

namespace tacto::firmware_host {

/// Prevents emulated time from being ahead of real time by more than a millisecond. After a delay of the
/// process, emulated time catches up.
class Pacer {
 public:
  void wait_until(double emulated_s) const {
    if (due(emulated_s) - Clock::now() > kSlack) std::this_thread::sleep_until(due(emulated_s));
  }
  /// Also for waits shorter than kSlack.
  void sleep_until(double emulated_s) const { std::this_thread::sleep_until(due(emulated_s)); }

  /// Real time since construction.
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

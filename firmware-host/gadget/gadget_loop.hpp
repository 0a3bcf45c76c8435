// SPDX-License-Identifier: GPL-3.0-or-later
// The gadget's main loop: runs the board's ticks by the clock, and moves bytes between board and cable.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "firmware-host/core/wire/message_types.hpp"
#include "firmware-host/gadget/board_link.hpp"
#include "firmware-host/gadget/gadget_board.hpp"

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

/// The fall of the drive to zero.
struct DriveFall {
  double from_v = 0;  ///< level in the tick before the fault
  double fell_s = 0;  ///< from that tick to the last tick with a drive
  double left_v = 0;  ///< level at the end of the observation: 0 if the drive stayed at zero
  /// Before the fault: the time since the tick before which the last bytes from the host arrived.
  double silent_s = 0;
};

/// Examines each tick, and continues for kWatchS after a fault. A drive that crosses zero has not ended: the
/// last tick with a drive is decisive.
class DriveWatch {
 public:
  static constexpr double kWatchS = 0.1;

  /// Bytes from the host have arrived since the last tick.
  void heard() { heard_ = true; }
  /// Call after each tick. Returns the fall when its observation is complete.
  std::optional<DriveFall> observe(wire::DriveState state, double drive_v, double period_s) {
    const bool fault = state == wire::DriveState::fault;
    silent_ticks_ = std::exchange(heard_, false) ? 0 : silent_ticks_ + 1;
    if (fault && !fault_) begin(period_s);
    fault_ = fault;
    before_v_ = std::abs(drive_v);
    rose_ = rested_ && drive_v != 0;
    if (rose_) rested_ = false;
    if (!watching_) return std::nullopt;
    ++ticks_;
    if (drive_v != 0) fall_.fell_s = static_cast<double>(ticks_) * period_s;
    if (fault && static_cast<double>(ticks_) * period_s < kWatchS) return std::nullopt;
    watching_ = false;
    fall_.left_v = before_v_;
    rested_ = drive_v == 0;
    return fall_;
  }
  /// Whether the last tick was the first one with a drive since a fall was returned.
  bool rose() const { return rose_; }

 private:
  void begin(double period_s) {
    fall_ = {before_v_, 0, 0, static_cast<double>(silent_ticks_) * period_s};
    ticks_ = 0;
    watching_ = true;
    rested_ = false;
  }

  DriveFall fall_;
  double before_v_ = 0;
  std::uint64_t ticks_ = 0, silent_ticks_ = 0;
  bool fault_ = false, watching_ = false, heard_ = false;
  bool rested_ = false, rose_ = false;
};

/// For one thread. If the host does not read, the board is not polled: as on a small device, its ring fills
/// and it counts its losses. After a fault it reports the last time of data from the host, the fall of the
/// drive, and the next rise of the drive.
class GadgetLoop {
 public:
  GadgetLoop(GadgetBoard& board, BoardLink& link, std::function<void(const std::string&)> say)
      : board_(board), link_(link), say_(std::move(say)) {}

  /// Runs until `stopped` returns true; it is called at least twenty times per second.
  void run(const std::function<bool()>& stopped);

 private:
  void exchange();
  void tick();
  void step();
  std::uint64_t due();

  GadgetBoard& board_;
  BoardLink& link_;
  std::function<void(const std::string&)> say_;
  TickPacer pacer_;
  DriveWatch drive_;
  bool told_slow_ = false;
};

}  // namespace tacto::firmware_host

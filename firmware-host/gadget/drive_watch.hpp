// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the drive after a fault, in the ticks of the device.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::firmware_host {

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

}  // namespace tacto::firmware_host

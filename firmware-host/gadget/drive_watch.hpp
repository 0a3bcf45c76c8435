// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of the drive after a fault, seen on the device.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::firmware_host {

/// A drive's way to zero.
struct DriveFall {
  double from_v = 0;  ///< level in the tick before the fault
  double fell_s = 0;  ///< from there to the last tick that had a drive
  double left_v = 0;  ///< level when the watch ended: 0 where the drive stayed away
};

/// Looks at each tick, and for kWatchS beyond a fault. A drive that crosses zero has not ended: what counts
/// is the last tick that had one.
class DriveWatch {
 public:
  static constexpr double kWatchS = 0.1;

  /// After each tick. Gives the fall once it has been watched to its end.
  std::optional<DriveFall> observe(wire::DriveState state, double drive_v, double period_s) {
    const bool fault = state == wire::DriveState::fault;
    if (fault && !fault_) begin();
    fault_ = fault;
    before_v_ = std::abs(drive_v);
    if (!watching_) return std::nullopt;
    ++ticks_;
    if (drive_v != 0) fall_.fell_s = static_cast<double>(ticks_) * period_s;
    if (fault && static_cast<double>(ticks_) * period_s < kWatchS) return std::nullopt;
    watching_ = false;
    fall_.left_v = before_v_;
    return fall_;
  }

 private:
  void begin() {
    fall_ = {before_v_, 0, 0};
    ticks_ = 0;
    watching_ = true;
  }

  DriveFall fall_;
  double before_v_ = 0;
  std::uint64_t ticks_ = 0;
  bool fault_ = false, watching_ = false;
};

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel lets this user's threads do in real time.
#pragma once

#include <optional>
#include <string>

namespace tacto::capture {

struct RealtimeLimits {
  unsigned long priority = 0;          ///< RLIMIT_RTPRIO: the highest that may be asked for, 0 for none
  bool granted = false;                ///< a thread asked for SCHED_FIFO and got it
  std::optional<double> locked_bytes;  ///< RLIMIT_MEMLOCK; none: without limit
  /// The part of each second that real-time threads may run, by sched_rt_runtime_us and _period_us; 1 where
  /// there is no throttle, none where the kernel doesn't say.
  std::optional<double> runtime;
};

/// `root` is where /proc is; "/" but in tests.
RealtimeLimits realtime_limits(const std::string& root = "/");

}  // namespace tacto::capture

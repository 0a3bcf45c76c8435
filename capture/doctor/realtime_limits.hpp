// SPDX-License-Identifier: GPL-3.0-or-later
// The real-time limits that the kernel sets for threads of this user.
#pragma once

#include <optional>
#include <string>

namespace tacto::capture {

struct RealtimeLimits {
  unsigned long priority = 0;  ///< RLIMIT_RTPRIO: the highest priority that may be requested, 0 for none
  bool granted = false;        ///< a thread requested SCHED_FIFO and received it
  std::optional<double> locked_bytes;  ///< RLIMIT_MEMLOCK; none: without limit
  /// The fraction of each second in which real-time threads may run, from sched_rt_runtime_us and _period_us;
  /// 1 without a throttle, none if the kernel does not provide it.
  std::optional<double> runtime;
};

/// `root` is the folder of /proc; only tests use another one than "/".
RealtimeLimits realtime_limits(const std::string& root = "/");

}  // namespace tacto::capture

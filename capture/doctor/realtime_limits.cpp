// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/doctor/realtime_limits.hpp"

#include <sys/resource.h>

#include <fstream>
#include <thread>

#include "firmware-host/link/realtime_priority.hpp"

namespace tacto::capture {
namespace {

std::optional<double> number_in(const std::string& path) {
  std::ifstream file(path);
  double number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

std::optional<double> runtime_part(const std::string& root) {
  const auto runtime_us = number_in(root + "proc/sys/kernel/sched_rt_runtime_us");
  const auto period_us = number_in(root + "proc/sys/kernel/sched_rt_period_us");
  if (!runtime_us || !period_us || *period_us <= 0) return std::nullopt;
  return *runtime_us < 0 ? 1 : *runtime_us / *period_us;
}

// In a separate thread, so that the priority of this one does not change.
bool is_granted() {
  bool granted = false;
  std::thread([&] { granted = firmware_host::RealtimePriority().granted(); }).join();
  return granted;
}

}  // namespace

RealtimeLimits realtime_limits(const std::string& root) {
  RealtimeLimits limits;
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) == 0) limits.priority = limit.rlim_cur;
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    limits.locked_bytes = static_cast<double>(limit.rlim_cur);
  limits.granted = is_granted();
  limits.runtime = runtime_part(root);
  return limits;
}

}  // namespace tacto::capture

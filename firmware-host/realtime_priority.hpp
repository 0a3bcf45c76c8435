// SPDX-License-Identifier: GPL-3.0-or-later
// A thread that must not wait for others' work, for as long as it is needed.
#pragma once

#include <pthread.h>
#include <sched.h>

namespace tacto::firmware_host {

/// Gives the calling thread the lowest priority of SCHED_FIFO, where the user may have it, and takes it back
/// at the end; threads made in between inherit it. Without the permission nothing happens: `tactograph
/// doctor` says whether there is one. Made and destroyed by the same thread.
class RealtimePriority {
 public:
  RealtimePriority() noexcept {
    const bool known = pthread_getschedparam(pthread_self(), &policy_, &before_) == 0;
    const sched_param lowest{sched_get_priority_min(SCHED_FIFO)};
    granted_ = known && pthread_setschedparam(pthread_self(), SCHED_FIFO, &lowest) == 0;
  }
  RealtimePriority(const RealtimePriority&) = delete;
  RealtimePriority& operator=(const RealtimePriority&) = delete;
  ~RealtimePriority() {
    if (granted_) pthread_setschedparam(pthread_self(), policy_, &before_);
  }
  bool granted() const noexcept { return granted_; }

 private:
  int policy_ = SCHED_OTHER;
  sched_param before_{};
  bool granted_ = false;
};

}  // namespace tacto::firmware_host

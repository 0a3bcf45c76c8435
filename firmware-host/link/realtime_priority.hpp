// SPDX-License-Identifier: GPL-3.0-or-later
// A thread that must not wait for others' work, for as long as it is needed.
#pragma once

#include <pthread.h>
#include <sched.h>

namespace tacto::firmware_host {

/// Gives the calling thread a priority of SCHED_FIFO (1 is the lowest; 0: none), where the user may have it,
/// and takes it back at the end; threads made in between inherit it. Without the permission nothing happens:
/// `tactograph doctor` says whether there is one. Made and destroyed by the same thread.
class RealtimePriority {
 public:
  explicit RealtimePriority(int priority = 1) noexcept {
    const bool known = pthread_getschedparam(pthread_self(), &policy_, &before_) == 0;
    const sched_param wish{priority};
    granted_ = known && priority > 0 && pthread_setschedparam(pthread_self(), SCHED_FIFO, &wish) == 0;
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

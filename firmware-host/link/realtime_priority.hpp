// SPDX-License-Identifier: GPL-3.0-or-later
// Real-time priority of a thread for the lifetime of an object.
#pragma once

#include <pthread.h>
#include <sched.h>

namespace tacto::firmware_host {

/// Sets the priority of the calling thread to SCHED_FIFO (1 is the lowest; 0: no change) if the user has the
/// permission, and restores it in the destructor; threads created in between inherit it. Without the
/// permission it has no effect: `tactograph doctor` reports it. Construct and destroy it in the same thread.
class RealtimePriority {
 public:
  explicit RealtimePriority(int priority = 1) noexcept {
    const bool known = pthread_getschedparam(pthread_self(), &policy_, &before_) == 0;
    const sched_param parameters{priority};
    granted_ = known && priority > 0 && pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
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

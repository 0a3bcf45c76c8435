// SPDX-License-Identifier: GPL-3.0-or-later
// Prevents deep idle states of the cores while a real-time loop runs.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>

namespace tacto::firmware_host {

/// While this object exists, the kernel (PM QoS, /dev/cpu_dma_latency) does not use idle states with a long
/// wake-up time; on a virtual machine this also prevents that a core is given away between two ticks. Without
/// the permission it has no effect.
class AwakeCores {
 public:
  AwakeCores() noexcept : file_(::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
    constexpr std::int32_t kMostLatency_us = 0;
    granted_ =
        file_ >= 0 && ::write(file_, &kMostLatency_us, sizeof kMostLatency_us) == sizeof kMostLatency_us;
  }
  AwakeCores(const AwakeCores&) = delete;
  AwakeCores& operator=(const AwakeCores&) = delete;
  ~AwakeCores() {
    if (file_ >= 0) ::close(file_);
  }
  bool granted() const noexcept { return granted_; }

 private:
  int file_;
  bool granted_ = false;
};

}  // namespace tacto::firmware_host

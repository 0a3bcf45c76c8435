// SPDX-License-Identifier: GPL-3.0-or-later
// Cores that answer at once: no deep idle while a real-time loop runs.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>

namespace tacto::firmware_host {

/// Asks the kernel (PM QoS, /dev/cpu_dma_latency) that no core sleep so deeply that waking takes time, for as
/// long as it lives; on virtual machines it also keeps a core from being given away between two ticks.
/// Without the permission nothing happens.
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

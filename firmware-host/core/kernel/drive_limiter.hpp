// SPDX-License-Identifier: Apache-2.0
// Keeps the drive within the transducer's limits.
#pragma once

#include <stdint.h>

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::core {

/// Limits the drive to +-drive_v, then the difference to the previous value to +-step_v. Safe in the tick.
class DriveLimiter {
 public:
  void set(float drive_v, float step_v) noexcept { drive_v_ = drive_v, step_v_ = step_v, last_v_ = 0; }

  /// `target_v` is finite. Sets in `flags` the limits that were active.
  float limit(float target_v, uint32_t& flags) noexcept {
    const float clamped_v = target_v > drive_v_ ? drive_v_ : target_v < -drive_v_ ? -drive_v_ : target_v;
    if (clamped_v != target_v) flags |= wire::kTickAmplitudeLimited;
    const float most_v = last_v_ + step_v_, least_v = last_v_ - step_v_;
    last_v_ = clamped_v > most_v ? most_v : clamped_v < least_v ? least_v : clamped_v;
    if (last_v_ != clamped_v) flags |= wire::kTickSlewLimited;
    return last_v_;
  }
  float last_v() const noexcept { return last_v_; }

 private:
  float drive_v_ = 0, step_v_ = 0, last_v_ = 0;
};

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// Limits the RMS of the drive over time, because drive heats the bender and fatigues the skin.
#pragma once

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::core {

/// Tracks the mean square e of the unlimited drive (one pole, `window` ticks) and multiplies the drive by
/// limit / root while the root of e is above the limit. The root is tracked by one Newton step per tick: the
/// gain has no steps, and the RMS stays within 2 % of the limit after `window`. A limit of 0 means none. Safe
/// in the tick.
class EnergyLimiter {
 public:
  void set(float rms_v, float window_ticks) noexcept {
    limit_v_ = rms_v;
    share_ = window_ticks > 1 ? 1 / window_ticks : 1;
    rest();
  }
  void rest() noexcept { mean_square_ = 0, root_v_ = limit_v_; }
  float limit(float unlimited_v, uint32_t& flags) noexcept {
    if (!(limit_v_ > 0)) return unlimited_v;
    mean_square_ += share_ * (unlimited_v * unlimited_v - mean_square_);
    if (mean_square_ < kSilence) mean_square_ = 0;  // no denormals: see SectionChain
    const float least = limit_v_ * limit_v_;
    if (mean_square_ <= least && root_v_ <= limit_v_ * kAtLimit) return root_v_ = limit_v_, unlimited_v;
    root_v_ = 0.5F * (root_v_ + (mean_square_ > least ? mean_square_ : least) / root_v_);
    if (mean_square_ > least) flags |= wire::kTickEnergyLimited;
    return unlimited_v * (limit_v_ / root_v_);
  }

 private:
  static constexpr float kSilence = 1e-30F;     // V^2
  static constexpr float kAtLimit = 1.000001F;  // above this, Newton's steps are rounding errors
  float limit_v_ = 0, share_ = 1, mean_square_ = 0, root_v_ = 0;
};

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// A filter with a finite impulse response.
#pragma once

#include "firmware-host/core/kernel/float4.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::core {

/// y_n = sum_i taps_i x_(n-i), in sixteen partial sums that are added at the end: the order is fixed, so that
/// the bits are the same everywhere. Always stable. Without taps it passes the input unchanged. Safe in the
/// tick.
class FirFilter {
 public:
  /// At most kMaxTaps; zeros are added up to a multiple of 16.
  void set(const float* taps, uint16_t count) noexcept {
    count_ = static_cast<uint16_t>((count + 15U) & ~15U);
    for (uint16_t i = 0; i < count_; ++i) reversed_[count_ - 1 - i] = i < count ? taps[i] : 0;
    rest();
  }
  /// Resets the states.
  void rest() noexcept {
    for (float& value : past_) value = 0;
    at_ = 0;
  }
  float filter(float x) noexcept {
    if (count_ == 0) return x;
    past_[at_] = past_[at_ + count_] = x;
    at_ = static_cast<uint16_t>(at_ + 1U == count_ ? 0U : at_ + 1U);
    const float* x_oldest = past_ + at_;
    Float4 sums[4] = {};
    for (unsigned i = 0; i < count_; i += 16)
      for (unsigned j = 0; j < 4; ++j) {
        const unsigned at = i + 4 * j;
        sums[j] += load_float4(reversed_ + at) * load_float4(x_oldest + at);
      }
    return sum_of((sums[0] + sums[2]) + (sums[1] + sums[3]));
  }

 private:
  float reversed_[wire::kMaxTaps] = {};
  float past_[2 * wire::kMaxTaps] = {};  // stored twice, so that a tick reads it contiguously
  uint16_t count_ = 0, at_ = 0;
};

}  // namespace tacto::core

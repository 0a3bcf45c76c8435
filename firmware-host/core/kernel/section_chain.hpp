// SPDX-License-Identifier: Apache-2.0
// Recursive filters as a chain of second-order sections.
#pragma once

#include "firmware-host/core/kernel/float4.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// Transposed direct form II, in single precision: y = b0 x + s1, s1 = b1 x - a1 y + s2, s2 = b2 x - a2 y.
/// The outputs of four consecutive sections are linear in x, and all other terms are known before the tick:
/// y_k = (b0_1 ... b0_k) x + c_k, c_k = b0_k c_(k-1) + s1_k. So the latency is one product and one sum for
/// four sections, and their states are computed in parallel; sections beyond a multiple of four are computed
/// one by one. The error against double precision increases as the poles approach the unit circle; TickKernel
/// states it. States below kSilence, about 500 dB below one volt, are set to zero, one section every
/// kFlushTicks ticks: otherwise a zero input would lead to denormal numbers, with which a tick takes tens of
/// times as long on some processors. Safe in the tick.
class SectionChain {
 public:
  void set(const wire::Section* sections, uint8_t count) noexcept {
    count_ = count;
    for (uint8_t i = 0; i < count; ++i) {
      const wire::Section& h = sections[i];
      b0_[i] = h.b0, b1_[i] = h.b1, b2_[i] = h.b2, a1_[i] = h.a1, a2_[i] = h.a2;
      through_[i] = i % 4 == 0 ? h.b0 : h.b0 * through_[i - 1];
    }
    rest();
  }
  /// Resets the states.
  void rest() noexcept {
    for (uint8_t i = 0; i < wire::kMaxSections; ++i) s1_[i] = s2_[i] = 0;
    until_calm_ = kFlushTicks, calm_ = 0;
  }
  /// Whether two chains with the same sections give the same output for every further input.
  bool is_where(const SectionChain& other) const noexcept {
    bool same = until_calm_ == other.until_calm_ && calm_ == other.calm_;
    for (uint8_t i = 0; i < count_; ++i) same = same && s1_[i] == other.s1_[i] && s2_[i] == other.s2_[i];
    return same;
  }
  float filter(float x) noexcept {
    if (--until_calm_ == 0) calm();
    uint8_t i = 0;
    for (; i + 4 <= count_; i = static_cast<uint8_t>(i + 4)) x = four_steps(i, x);
    for (; i < count_; ++i) x = step(i, x);
    return x;
  }

 private:
  static constexpr float kSilence = 1e-25F;
  static constexpr uint8_t kFlushTicks = 8;

  static bool is_silent(float state) noexcept { return state < kSilence && state > -kSilence; }
  // Both states or none: a single remaining state would excite the section again.
  [[gnu::noinline]] void calm() noexcept {
    until_calm_ = kFlushTicks;
    calm_ = static_cast<uint8_t>(calm_ + 1 < count_ ? calm_ + 1 : 0);
    if (is_silent(s1_[calm_]) && is_silent(s2_[calm_])) s1_[calm_] = s2_[calm_] = 0;
  }
  float step(uint8_t i, float x) noexcept {
    const float y = b0_[i] * x + s1_[i];
    s1_[i] = b1_[i] * x - a1_[i] * y + s2_[i];
    s2_[i] = b2_[i] * x - a2_[i] * y;
    return y;
  }
  float four_steps(uint8_t i, float first) noexcept {
    const float c0 = s1_[i], c1 = b0_[i + 1] * c0 + s1_[i + 1];
    const float c2 = b0_[i + 2] * c1 + s1_[i + 2], c3 = b0_[i + 3] * c2 + s1_[i + 3];
    const Float4 y = load_float4(through_ + i) * first + Float4{c0, c1, c2, c3};
    const Float4 x = {first, y[0], y[1], y[2]};
    store_four(s1_ + i, load_float4(b1_ + i) * x - load_float4(a1_ + i) * y + load_float4(s2_ + i));
    store_four(s2_ + i, load_float4(b2_ + i) * x - load_float4(a2_ + i) * y);
    return y[3];
  }

  float b0_[wire::kMaxSections] = {}, b1_[wire::kMaxSections] = {}, b2_[wire::kMaxSections] = {};
  float a1_[wire::kMaxSections] = {}, a2_[wire::kMaxSections] = {};
  float through_[wire::kMaxSections] = {};  // product of b0 from the first of its group of four
  float s1_[wire::kMaxSections] = {}, s2_[wire::kMaxSections] = {};
  uint8_t count_ = 0, until_calm_ = kFlushTicks, calm_ = 0;
};

/// True if the poles are within the unit circle (Jury: |a2| < 1, |a1| < 1 + a2) and all coefficients are
/// finite.
bool is_stable(const wire::Section& section) noexcept;

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// Recursive filters as a chain of second-order sections.
#pragma once

#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// Transposed direct form II, in single precision: y = b0 x + s1, s1 = b1 x - a1 y + s2, s2 = b2 x - a2 y.
/// The error against double precision grows as the poles come near the unit circle; TickKernel says its size.
/// Safe in the tick.
class SectionChain {
 public:
  void set(const wire::Section* sections, uint8_t count) noexcept {
    count_ = count;
    for (uint8_t i = 0; i < count; ++i) sections_[i] = sections[i];
    rest();
  }
  /// Forgets the past.
  void rest() noexcept {
    for (State& state : states_) state = {};
  }
  /// Of a chain with the same sections: whatever comes in next, both give the same.
  bool is_where(const SectionChain& other) const noexcept {
    bool same = true;
    for (uint8_t i = 0; i < count_; ++i)
      same = same && states_[i].s1 == other.states_[i].s1 && states_[i].s2 == other.states_[i].s2;
    return same;
  }
  float filter(float x) noexcept {
    for (uint8_t i = 0; i < count_; ++i) x = step(sections_[i], states_[i], x);
    return x;
  }

 private:
  struct State {
    float s1 = 0, s2 = 0;
  };
  static float step(const wire::Section& h, State& state, float x) noexcept {
    const float y = h.b0 * x + state.s1;
    state.s1 = h.b1 * x - h.a1 * y + state.s2;
    state.s2 = h.b2 * x - h.a2 * y;
    return y;
  }

  wire::Section sections_[wire::kMaxSections];
  State states_[wire::kMaxSections];
  uint8_t count_ = 0;
};

/// True where the poles lie within the unit circle (Jury: |a2| < 1, |a1| < 1 + a2) and all is finite.
bool is_stable(const wire::Section& section) noexcept;

}  // namespace tacto::core

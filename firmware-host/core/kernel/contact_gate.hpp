// SPDX-License-Identifier: Apache-2.0
// No finger, no drive.
#pragma once

#include "firmware-host/core/kernel/envelope.hpp"
#include "firmware-host/core/kernel/finite.hpp"

namespace tacto::core {

/// A normal force that nobody reports: the gate is open.
inline constexpr float kNoForce = __builtin_nanf("");

/// Opens over `ticks` where the normal force reaches `on_n`, closes where it falls below `off_n`. With on_n
/// of 0, or where nobody reports a force, it is open. Safe in the tick.
class ContactGate {
 public:
  void set(float on_n, float off_n, float ticks) noexcept {
    on_n_ = on_n, off_n_ = off_n, touching_ = false;
    weight_.set(ticks, ticks);
  }
  float step(float force_n) noexcept {
    if (!(on_n_ > 0)) return 1;
    if (!is_finite(force_n)) return weight_.step(true), 1;
    touching_ = touching_ ? force_n >= off_n_ : force_n >= on_n_;
    return weight_.step(touching_);
  }
  /// All that it needs of the force, as of the last step: who replays it is told this, and no force.
  bool touching() const noexcept { return touching_; }

 private:
  float on_n_ = 0, off_n_ = 0;
  bool touching_ = false;
  Envelope weight_;
};

}  // namespace tacto::core

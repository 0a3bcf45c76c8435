// SPDX-License-Identifier: Apache-2.0
// Passes the drive only while the finger presses.
#pragma once

#include "firmware-host/core/kernel/envelope.hpp"
#include "firmware-host/core/kernel/finite.hpp"

namespace tacto::core {

/// No normal force is reported: the gate is open.
inline constexpr float kNoForce = __builtin_nanf("");

/// Opens over `ticks` when the normal force reaches `on_n`, closes when it falls below `off_n`. It is open if
/// on_n is 0 or no force is reported. Safe in the tick.
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
  /// The decision of the last step. A replay uses it in place of the force.
  bool touching() const noexcept { return touching_; }

 private:
  float on_n_ = 0, off_n_ = 0;
  bool touching_ = false;
  Envelope weight_;
};

}  // namespace tacto::core

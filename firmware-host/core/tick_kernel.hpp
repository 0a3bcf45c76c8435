// SPDX-License-Identifier: Apache-2.0
// The one tick kernel: what is wanted becomes what is driven.
#pragma once

#include "firmware-host/core/drive_limiter.hpp"
#include "firmware-host/core/envelope.hpp"
#include "firmware-host/core/finite.hpp"
#include "firmware-host/core/profile.hpp"
#include "firmware-host/core/section_chain.hpp"

namespace tacto::core {

/// drive = limits(envelope x sections(wanted)), where wanted = gain x profile(encoder count), or comes from
/// elsewhere. Single precision, no contraction, no libm: the same bits on host and device (a test holds the
/// two against each other). Against double precision, eight sections, 20 kHz: -100 dB of the drive for an
/// actuator's inverse (poles of radius 0.99 at most), -65 dB where three of them are high-passes of 15 Hz
/// (0.9967): such belong into the texture. A drive that is cut at its limits has the error that it has uncut.
/// tick() neither allocates, locks, throws nor calls.
class TickKernel {
 public:
  /// Comes to rest at zero. A rate in Hz, above zero; limits as wire::Limits.
  void set(const wire::Limits& limits, float rate_hz) noexcept {
    envelope_.set(limits.onset_s * rate_hz, limits.release_s * rate_hz);
    limiter_.set(limits.drive_v, limits.slew_v_per_s / rate_hz);
    sections_.rest();
  }
  void set_profile(const Profile& profile) noexcept { profile_ = profile; }
  SectionChain& sections() noexcept { return sections_; }

  /// What the profile wants at a count.
  float wanted(int32_t count, float gain) const noexcept { return gain * profile_.at(count); }

  /// One tick. `raise`: towards the full drive, else towards zero. What is no finite number drives zero, and
  /// `sound` is false.
  float tick(float wanted, bool raise, uint32_t& flags, bool& sound) noexcept {
    const float filtered = sections_.filter(wanted);
    sound = is_finite(filtered);
    if (!sound) sections_.rest();
    const float weight = envelope_.step(raise && sound);
    return limiter_.limit(sound ? filtered * weight : 0, flags);
  }
  bool at_rest() const noexcept { return envelope_.at_rest() && limiter_.last_v() == 0; }
  float last_v() const noexcept { return limiter_.last_v(); }

 private:
  Profile profile_;
  SectionChain sections_;
  Envelope envelope_;
  DriveLimiter limiter_;
};

}  // namespace tacto::core

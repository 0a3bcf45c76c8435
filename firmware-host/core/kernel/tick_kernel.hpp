// SPDX-License-Identifier: Apache-2.0
// The tick kernel: from target signal to drive. Host and device use the same one.
#pragma once

#include "firmware-host/core/kernel/contact_gate.hpp"
#include "firmware-host/core/kernel/drive_limiter.hpp"
#include "firmware-host/core/kernel/energy_limiter.hpp"
#include "firmware-host/core/kernel/fir_filter.hpp"
#include "firmware-host/core/kernel/play_operators.hpp"
#include "firmware-host/core/kernel/section_chain.hpp"
#include "firmware-host/core/kernel/texture_player.hpp"

namespace tacto::core {

/// The complete setup of the kernel, as plain data; data that it points to must outlive its use by the
/// kernel.
struct KernelSetup {
  TextureSetup texture;
  const float* taps = nullptr;
  uint16_t tap_count = 0;
  const wire::Hysteresis* hysteresis = nullptr;
  const wire::Section* sections = nullptr;
  uint8_t section_count = 0;
  wire::Limits limits;
  float rate_hz = 10e3F;
  float energy_rms_v = 0, energy_window_s = 0;  ///< 0: no limit
  float gate_on_n = 0, gate_off_n = 0;          ///< 0: not gated
};

/// The rate as both sides of the wire compute it, Hz.
inline float rate_of(uint32_t millihertz) noexcept {
  return 1e-3F * static_cast<float>(millihertz);
}

/// A change of the gain takes this long.
inline constexpr float kGainS = 0.01F;

/// The input of a tick.
struct TickInput {
  int32_t count = 0;                ///< of the encoder
  float gain = 0;                   ///< of the texture; a change takes 10 ms
  bool raise = false;               ///< towards the full drive, otherwise towards zero
  float normal_force_n = kNoForce;  ///< if it is reported
};

/// The output of a tick.
struct TickOutput {
  float drive_v = 0;
  float unlimited_v = 0;  ///< before the limits; limits removed the difference to drive_v
  uint32_t flags = 0;     ///< wire::TickFlag: amplitude, slew, energy, gated, touching
  bool sound = true;      ///< false if the target is not finite; then the drive falls
};

/// drive = limits(energy(envelope x gate x sections(play_operators(taps(target))))), where target = gain x
/// texture(position of the finger) or an external signal. Single precision, no contraction, no libm: the same
/// bits on host and device (a test compares them). Error against double precision: a texture with levels,
/// taps, tracking and limits, 2 kHz to 20 kHz: -105 dB of the drive; eight sections, 20 kHz: -100 dB for an
/// actuator's inverse (pole radius at most 0.99), -64 dB if three of them are high-passes of 15 Hz (0.9967),
/// which should therefore be applied to the texture. Limiting does not increase the error. No function here
/// allocates, locks, throws or makes system calls.
class TickKernel {
 public:
  /// Sets all parameters; starts at rest at zero.
  void set(const KernelSetup& setup) noexcept;

  /// Cross-fades to another texture over `fade_s`; until then both must exist. Between ticks.
  void change(const TextureSetup& texture, float fade_s) noexcept {
    player_.change(texture, fade_s * rate_hz_);
  }
  /// Resets the speed of the finger: between ticks, at rest.
  void reset_finger_speed() noexcept { player_.reset_finger_speed(); }
  bool changing() const noexcept { return player_.changing(); }

  /// One tick of the texture.
  TickOutput tick(const TickInput& input) noexcept;

  /// The texture's target at a count; once a tick.
  float target(int32_t count, float gain) noexcept { return player_.target(count, gain); }
  /// One tick of a target, from the texture or external.
  TickOutput drive(float target, bool raise, float normal_force_n) noexcept;

  bool at_rest() const noexcept { return envelope_.at_rest() && limiter_.last_v() == 0; }
  float last_v() const noexcept { return limiter_.last_v(); }

 private:
  TexturePlayer player_;
  FirFilter fir_;
  PlayOperators plays_;
  SectionChain sections_;
  ContactGate gate_;
  EnergyLimiter energy_;
  Envelope envelope_;
  DriveLimiter limiter_;
  float rate_hz_ = 1;
};

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
// The displacement of a tray under the held drive, for QEMU, which has no tray: the equations of motion of
// the transducer wiertlewski2011.
#pragma once

#include "firmware-host/boards/shared/tray_board.hpp"

namespace tacto::stm32f405 {

/// A mass on a spring and a damper, which a bender pushes in proportion to its voltage; that voltage follows
/// the drive behind a resistor.
class EmulatedTray {
 public:
  /// Of the displacement, as the converter gives it, with white noise of one code (RMS) before its rounding.
  int32_t code() {
    constexpr auto kFullM = static_cast<float>(boards::kTrayMPerV * boards::kDividedFullV);
    const float code = 2048.5F + noise() + (x_m_ + kMPerV * held_v_) * (2048 / kFullM);
    return boards::left_justified(static_cast<uint32_t>(code < 0 ? 0 : code > 4095 ? 4095 : code));
  }

  /// Goes on for a period under this code of the drive. Relative to its rest under that drive, the motion is
  /// linear without an input, and its Taylor series ends below single precision: eight terms of an eighth of
  /// a period, at 500 Hz or more.
  void hold(uint32_t drive_code, float period_s) {
    const float drive_v = boards::volts_of(drive_code);
    bender_v_ += held_v_ - drive_v;
    x_m_ += kMPerV * (held_v_ - drive_v);
    held_v_ = drive_v;
    for (unsigned part = 0; part < 8; ++part) advance(period_s / 8);
  }

 private:
  // Uniform, of variance 1; the generator is that of Numerical Recipes, 7.1.
  float noise() {
    random_ = 1664525 * random_ + 1013904223;
    return (static_cast<float>(random_ >> 8) / 8388608.0F - 1) * 1.7320508F;
  }

  static constexpr float kMassKg = 6.8e-3F, kStiffness = 8.052e4F, kDamping = 4.49F;  // N/m, N s/m
  static constexpr float kMPerV = 20e-6F, kBenderS = 680 * 1.636e-6F;

  void advance(float time_s) {
    float v = bender_v_, x = x_m_, speed = speed_m_s_;  // one term of each series
    for (unsigned n = 1; n <= 8; ++n) {
      const float part_s = time_s / static_cast<float>(n);
      const float force_n = kStiffness * (kMPerV * v - x) - kDamping * speed;
      v *= -part_s / kBenderS;
      x = part_s * speed;
      speed = part_s * force_n / kMassKg;
      bender_v_ += v;
      x_m_ += x;
      speed_m_s_ += speed;
    }
  }

  float bender_v_ = 0, x_m_ = 0, speed_m_s_ = 0;  // without what belongs to the held drive
  float held_v_ = 0;
  uint32_t random_ = 1;
};

}  // namespace tacto::stm32f405

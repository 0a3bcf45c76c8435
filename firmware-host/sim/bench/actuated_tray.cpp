// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/bench/actuated_tray.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware-host/sim/bench/bench.hpp"

namespace tacto::firmware_host {
ActuatedTray::ActuatedTray(const schema::Transducer& t, double tick_rate_hz, const TrayPhysics& physics)
    : mechanics_(t, physics),
      hysteresis_(physics.hysteresis, t.max_voltage_v),
      force_n_per_v_(t.deflection_m / t.max_voltage_v * t.bender_stiffness_n_per_m * t.actuator_scale),
      amplifier_gain_(t.amplifier_gain),
      time_constant_s_(2 * t.amplifier_resistance_ohm * t.capacitance_f),
      filter_rad_per_s_(2 * std::numbers::pi * physics.reconstruction_cutoff_hz.value_or(0)),
      drive_limit_v_(t.drive_limit_v),
      step_s_(1 / (tick_rate_hz * substeps_in(1 / tick_rate_hz))),
      substeps_(substeps_in(1 / tick_rate_hz)) {}

// The Butterworth poles: one real, and a pair of damping ratio 1/2.
ActuatedTray::State ActuatedTray::rate(const State& s, double drive_v, double force_n) const {
  const double w = filter_rad_per_s_;
  const double smoothed_v = w > 0 ? s[kFilteredV] : drive_v;
  const TrayMotion motion{s[kTrayM], s[kTrayMps], s[kInnerM], s[kInnerMps]};
  return {w * (drive_v - s[kFirstOrderV]),
          s[kFilteredSlope],
          w * (w * (s[kFirstOrderV] - s[kFilteredV]) - s[kFilteredSlope]),
          (amplifier_gain_ * smoothed_v - s[kPiezoV]) / time_constant_s_,
          s[kTrayMps],
          mechanics_.tray_mps2(motion, force_n_per_v_ * hysteresis_.at(s[kPiezoV]) + force_n),
          s[kInnerMps],
          mechanics_.inner_mps2(motion)};
}

// For a value that is not a number, the drive is zero.
double ActuatedTray::within_limit(double drive_v) {
  if (std::abs(drive_v) <= drive_limit_v_) return drive_v;
  ++limited_ticks_;
  return std::isnan(drive_v) ? 0 : std::clamp(drive_v, -drive_limit_v_, drive_limit_v_);
}

double ActuatedTray::tick(double drive_v, double finger_force_n) {
  const double before_m = state_[kTrayM];
  const double held_v = within_limit(drive_v);
  for (int i = 0; i < substeps_; ++i) {
    state_ = runge_kutta_step(state_, step_s_,
                              [&](const State& s, double) { return rate(s, held_v, finger_force_n); });
    hysteresis_.settle(state_[kPiezoV]);
  }
  return before_m;
}

std::vector<double> displacement_under(ActuatedTray& tray, std::span<const double> drive_v) {
  std::vector<double> displacement_m;
  displacement_m.reserve(drive_v.size());
  for (const double v : drive_v) displacement_m.push_back(tray.tick(v));
  return displacement_m;
}

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer as an actuator: the motion of the tray under a drive, from the equations of motion.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/physics/bender_hysteresis.hpp"
#include "firmware-host/sim/physics/runge_kutta.hpp"
#include "firmware-host/sim/physics/tray_mechanics.hpp"

namespace tacto::firmware_host {

/// Wiertlewski 2011, equations (5) and (6). The drive V_a is held for a tick, as by a converter. Optionally
/// an analog Butterworth low-pass of order 3 smooths it (the paper's reconstruction filter, 600 Hz):
///   v_1' = w (V_a - v_1),   v'' = w (w (v_1 - v) - v'),   and then, with v as V_a,
///   2 R_a C_p V_p' = G_a V_a - V_p,
///   m x'' + b_r x' + (k_r + k_p) x = 2 beta k_p V_p x actuator_scale + F_d.
/// Optionally the bender has hysteresis (in V_p, between +-v_max), the mass has a second mode, and a resting
/// finger loads it (TrayPhysics). Runge-Kutta steps of at most 12.5 us; against the exact response at the
/// resonance the relative error is below 1e-6. A drive beyond +-drive_limit_v is limited to it and counted.
/// Not safe to share between threads; no allocation after construction.
class ActuatedTray {
 public:
  /// Starts at rest at 0. The tick rate is in Hz, above 0. Preconditions of TrayMechanics and
  /// BenderHysteresis; the filter's cut-off is at most 5 kHz, where the error of the steps is at most 2e-4
  /// per radian.
  ActuatedTray(const schema::Transducer& transducer, double tick_rate_hz, const TrayPhysics& physics = {});

  /// Returns the displacement in metres at the beginning of the tick; then `drive_v` and the finger's force
  /// on the tray are held until its end.
  double tick(double drive_v, double finger_force_n = 0);

  double displacement_m() const { return state_[kTrayM]; }
  double speed_mps() const { return state_[kTrayMps]; }
  std::uint64_t limited_ticks() const { return limited_ticks_; }

 private:
  enum : std::size_t {
    kFirstOrderV,
    kFilteredV,
    kFilteredSlope,
    kPiezoV,
    kTrayM,
    kTrayMps,
    kInnerM,
    kInnerMps,
    kStates
  };
  using State = OdeState<kStates>;
  State rate(const State& state, double drive_v, double force_n) const;
  double within_limit(double drive_v);

  TrayMechanics mechanics_;
  BenderHysteresis hysteresis_;
  double force_n_per_v_;  // 2 beta k_p, scaled
  double amplifier_gain_, time_constant_s_;
  double filter_rad_per_s_;  // 0: no filter
  double drive_limit_v_;
  double step_s_;
  int substeps_;
  State state_{};
  std::uint64_t limited_ticks_ = 0;
};

/// Displacement[i] is the position of the tray when drive[i] begins: the tray's response, sampled at the
/// ticks.
std::vector<double> displacement_under(ActuatedTray& tray, std::span<const double> drive_v);

}  // namespace tacto::firmware_host

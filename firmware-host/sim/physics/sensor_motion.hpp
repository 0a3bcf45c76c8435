// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer as a sensor, as equations of motion.
#pragma once

#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/physics/tray_mechanics.hpp"

namespace tacto::firmware_host {

struct SensorState {
  double tray_m = 0;        ///< x
  double tray_mps = 0;      ///< dx/dt
  double charge_lag_n = 0;  ///< the bender's force k_p x after the low-pass of R_s and C_p
  double inner_m = 0;       ///< of the second mode
  double inner_mps = 0;
};

/// Wiertlewski 2011, equations (1) to (3). A force f on the tray bends the piezo bender, m x'' + b_r x' +
/// (k_r + k_p) x = f. The charge from its force k_p x leaks through the load resistors, u' = (k_p x - u) / (2
/// R_s C_p), and the amplifier gives V_s = -G_s (beta / C_p) (k_p x - u) x sensor_scale. Optionally the mass
/// has a second mode.
class SensorMotion {
 public:
  explicit SensorMotion(const schema::Transducer& transducer,
                        const std::optional<SecondMode>& second_mode = std::nullopt);

  SensorState rate(const SensorState& state, double force_n) const {
    const TrayMotion motion{state.tray_m, state.tray_mps, state.inner_m, state.inner_mps};
    return {state.tray_mps, mechanics_.tray_mps2(motion, force_n),
            (bender_n_per_m_ * state.tray_m - state.charge_lag_n) / time_constant_s_, state.inner_mps,
            mechanics_.inner_mps2(motion)};
  }
  double output_v(const SensorState& state) const {
    return -output_v_per_n_ * (bender_n_per_m_ * state.tray_m - state.charge_lag_n);
  }
  /// Volts per newton in the middle of the band, where resonance and leak are negligible (without sign).
  double middle_gain_v_per_n() const {
    return output_v_per_n_ * bender_n_per_m_ / mechanics_.stiffness_n_per_m();
  }

 private:
  TrayMechanics mechanics_;
  double bender_n_per_m_, time_constant_s_, output_v_per_n_;
};

}  // namespace tacto::firmware_host

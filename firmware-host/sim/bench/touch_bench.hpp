// SPDX-License-Identifier: GPL-3.0-or-later
// The whole mechanical system: a fingertip on a surface on the transducer's tray, from the equations of
// motion.
#pragma once

#include <cstdint>

#include "firmware-host/sim/bench/bench.hpp"
#include "firmware-host/sim/physics/lugre_friction.hpp"
#include "firmware-host/sim/physics/ridge_contact.hpp"
#include "firmware-host/sim/physics/runge_kutta.hpp"
#include "firmware-host/sim/physics/sensor_motion.hpp"

namespace tacto::firmware_host {

/// States: position and speed of the pulp, bristles, and the state of the sensor (SensorState). The bone
/// pulls the pulp through spring and damper; friction and slopes act on the pulp and, with the opposite sign,
/// on the tray:
///   m_f x_f'' = k_f (X - x_f) + c_f (X' - x_f') - f_d,   f_d = mu(z, x_f' - x') N + sum p_i h'_i(x_f - x).
/// Runge-Kutta steps of at most 12.5 us, ten to twenty per period of the fastest mode (a sticking pulp on its
/// bristles, about 700 Hz).
class TouchBench final : public Bench {
 public:
  TouchBench(const schema::Transducer& transducer, const FingerParameters& finger,
             const HeightProfile& profile, double sample_rate_hz, double start_m, std::uint64_t seed,
             const std::optional<SecondMode>& second_mode = std::nullopt);

  /// Diverged: a value that is not a number, or a distance of more than the patch between pulp and bone.
  bool step(const FingerPlace& bone, double load_n) override;
  BenchReading reading() const override { return reading_; }

 private:
  using State = OdeState<8>;
  struct Drag {
    double position_m, speed_mps, load_n;
  };
  double tray_force_n(const State& state, double load_n, double& bristle_rate_mps);
  State rate(const State& state, const Drag& drag);
  bool sane(const State& state, double bone_m) const;

  FingerParameters finger_;
  SensorMotion sensor_;
  RidgeContact ridges_;
  double period_s_;
  int substeps_;
  State state_{};
  BenchReading reading_;
};

}  // namespace tacto::firmware_host

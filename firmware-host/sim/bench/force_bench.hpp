// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's tray under a known force instead of a finger.
#pragma once

#include <cstdint>

#include "firmware-host/sim/bench/bench.hpp"
#include "firmware-host/sim/physics/known_force.hpp"
#include "firmware-host/sim/physics/runge_kutta.hpp"
#include "firmware-host/sim/physics/sensor_motion.hpp"

namespace tacto::firmware_host {

/// The force begins at 0 s with the tray at rest; the bone only moves the position sensor, and the load only
/// presses. Runge-Kutta steps as elsewhere: the sensor's closed form is matched to 1e-5.
class ForceBench final : public Bench {
 public:
  ForceBench(const schema::Transducer& transducer, const ForcePlan& force, double sample_rate_hz,
             const std::optional<SecondMode>& second_mode = std::nullopt);

  bool step(const FingerPlace& bone, double load_n) override;
  BenchReading reading() const override { return reading_; }

 private:
  SensorMotion sensor_;
  KnownForce force_;
  double step_s_;
  int substeps_;
  std::uint64_t steps_ = 0;
  SensorState state_;
  BenchReading reading_;
};

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// One run of the emulated device, from its first frame on.
#pragma once

#include <cstdint>
#include <span>

#include "data-schema/transducer.hpp"
#include "firmware-host/sim/converter.hpp"
#include "firmware-host/sim/finger_path.hpp"
#include "firmware-host/sim/load_cell.hpp"
#include "firmware-host/sim/sim_parameters.hpp"
#include "firmware-host/sim/spline_noise.hpp"
#include "firmware-host/sim/touch_bench.hpp"

namespace tacto::firmware_host {

inline constexpr std::size_t kSimChannels = 4;  ///< tangential_force, position, normal_force, net_force

/// The bench and what reads it: the piezo's converter with the noise floor before it, the encoder, the load
/// cell's axes.
class SimRun {
 public:
  SimRun(const SimParameters& parameters, const schema::Transducer& transducer, const HeightProfile& profile);

  /// One sample period on, and the frame at its end. False where the simulated motion has diverged.
  bool next(std::span<std::int32_t, kSimChannels> frame);
  /// The encoder's, where the finger is now.
  std::int32_t encoder_count() const;
  const LoadCell& normal_cell() const { return normal_cell_; }
  const LoadCell& net_cell() const { return net_cell_; }
  const Converter& converter() const { return converter_; }

 private:
  double load_n(const FingerPlace& place);
  std::int32_t count_at(double position_m) const;

  SimParameters parameters_;
  FingerPath path_;
  SplineNoise load_wander_;
  TouchBench bench_;
  Random noise_;
  double noise_v_;
  Converter converter_;
  LoadCell normal_cell_, net_cell_;
  std::uint64_t frames_ = 0;
};

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// The inductive position sensor on the fingernail.
#pragma once

#include <cstdint>

#include "firmware-host/sim/physics/converter.hpp"
#include "firmware-host/sim/physics/random.hpp"

namespace tacto::firmware_host {

/// After the LVDT of Wiertlewski 2011, section III-D (Sensorex SX 12N060: 60 mm of travel). Bandwidth and
/// noise are our choice: a demodulator's first-order low-pass, and typical noise of such sensors.
struct LvdtParameters {
  double range_m = 60e-3;  ///< from end to end
  double bandwidth_hz = 200;
  double noise_m = 2e-6;  ///< RMS
};

/// A first-order low-pass, tau y' = x - y, integrated from rest at the first position; white noise; 16 bits
/// over the range about `centre_m`: the codes are those of y - centre.
class Lvdt {
 public:
  Lvdt(const LvdtParameters& parameters, double centre_m, double start_m, double sample_rate_hz, bool noise,
       Random random);

  /// The code of a sample; the position has moved linearly to `position_m`.
  std::int32_t step(double position_m);
  const Converter& converter() const { return converter_; }
  double centre_m() const { return centre_m_; }

 private:
  Converter converter_;
  Random random_;
  double centre_m_, noise_m_, time_constant_s_, step_s_;
  int substeps_;
  double before_m_, filtered_m_;
};

}  // namespace tacto::firmware_host

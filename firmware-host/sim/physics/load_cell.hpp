// SPDX-License-Identifier: GPL-3.0-or-later
// The strain-gauge force sensor under the transducer, one axis of it.
#pragma once

#include <cstdint>

#include "firmware-host/sim/physics/converter.hpp"
#include "firmware-host/sim/physics/random.hpp"

namespace tacto::firmware_host {

/// After the ATI Nano17 of Wiertlewski 2011, section III-D (calibration SI-12-0.12: 12 N tangentially, 17 N
/// normally, resolution 1/320 N): slow, and much noisier than the piezo. A first-order low-pass, noise of the
/// size of the resolution, 16 bits; sampled about 1000 times per second and held in between.
class LoadCell {
 public:
  LoadCell(double range_n, double sample_rate_hz, bool noise, Random random);

  /// The code for one sample of the recording.
  std::int32_t step(double force_n);
  const Converter& converter() const { return converter_; }
  double native_rate_hz() const { return native_rate_hz_; }

 private:
  Converter converter_;
  Random random_;
  int every_;
  double native_rate_hz_, follow_, noise_n_;
  double filtered_n_ = 0;
  int until_next_ = 0;
  std::int32_t held_ = 0;
};

}  // namespace tacto::firmware_host

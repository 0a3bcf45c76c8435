// SPDX-License-Identifier: GPL-3.0-or-later
// The instrument that measures the motion of the driven tray, for identification.
#pragma once

#include <cstdint>

#include "firmware-host/sim/device/sim_parameters.hpp"
#include "firmware-host/sim/physics/converter.hpp"
#include "firmware-host/sim/physics/random.hpp"

namespace tacto::firmware_host {

/// A vibrometer as fast as the stream, with white noise, 16 bits over +-200 um: twice the permitted
/// displacement of the paper's transducer. One sample per tick, at the position of the tray when the tick's
/// drive begins.
class TraySensor {
 public:
  explicit TraySensor(const SimParameters& parameters)
      : random_(parameters.seed, kTraySensorStream),
        noise_m_(parameters.noise ? parameters.tray_sensor_noise_m : 0) {}

  std::int32_t step(double displacement_m) {
    return converter_.convert(displacement_m + noise_m_ * random_.normal());
  }
  const Converter& converter() const { return converter_; }

 private:
  static constexpr std::uint64_t kTraySensorStream = 200;
  Converter converter_{16, 200e-6};
  Random random_;
  double noise_m_;
};

}  // namespace tacto::firmware_host

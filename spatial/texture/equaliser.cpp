// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/equaliser.hpp"

#include <cmath>

namespace tacto::spatial {

SpectralGain equaliser(const schema::Transducer& transducer) {
  const double newtons_per_volt = schema::nominal_newtons_per_volt(transducer);
  return [transducer, newtons_per_volt](double frequency_hz) -> std::complex<double> {
    const std::complex<double> seen = schema::sensor_response(transducer, frequency_hz) * newtons_per_volt;
    const double size = std::abs(seen);
    if (size == 0) return 0;
    return size * kMostEqualiserGain >= 1 ? 1.0 / seen : std::conj(seen) / size * kMostEqualiserGain;
  };
}

}  // namespace tacto::spatial

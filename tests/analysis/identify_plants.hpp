// SPDX-License-Identifier: GPL-3.0-or-later
// Transducers for identification, and measurements of them.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/physics/tray_mechanics.hpp"

namespace tacto::analysis {

inline std::vector<double> octaves(double low_hz, double high_hz, int count) {
  std::vector<double> list;
  for (int i = 0; i < count; ++i)
    list.push_back(low_hz * std::pow(high_hz / low_hz, double(i) / (count - 1)));
  return list;
}

/// Mass, damping, resistors and scales within a factor of 1.6 either way.
inline schema::Transducer varied(schema::Transducer t, std::mt19937_64& random) {
  std::uniform_real_distribution<double> even(-0.47, 0.47);
  for (double* value : {&t.mass_kg, &t.damping_n_s_per_m, &t.amplifier_resistance_ohm,
                        &t.sensor_resistance_ohm, &t.actuator_scale, &t.sensor_scale})
    *value *= std::exp(even(random));
  return t;
}

/// The next one that can have the tray's second mode.
inline schema::Transducer varied(const schema::Transducer& t, const firmware_host::TrayPhysics& physics,
                                 std::mt19937_64& random) {
  for (;;) {
    const schema::Transducer truth = varied(t, random);
    const auto& mode = physics.second_mode;
    if (!mode || firmware_host::least_second_mode_hz(truth, *mode) <= mode->frequency_hz) return truth;
  }
}

inline std::complex<double> response_of(const schema::Transducer& t, Direction direction, double hz) {
  return direction == Direction::actuator ? schema::actuator_response(t, hz) : schema::sensor_response(t, hz);
}

/// The closed form with Gaussian noise of `part` of the median amplitude on real and imaginary part.
inline BodeData measured(const schema::Transducer& t, Direction direction,
                         const std::vector<double>& frequencies, double part, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double sigma = part * std::abs(response_of(t, direction, 100));
  BodeData data;
  data.direction = direction;
  data.source = "closed form";
  data.frequency_hz = frequencies;
  for (const double hz : frequencies) {
    const std::complex<double> error(sigma * normal(random), sigma * normal(random));
    data.response.push_back(response_of(t, direction, hz) + error);
    data.noise.push_back(sigma);
  }
  return data;
}

}  // namespace tacto::analysis

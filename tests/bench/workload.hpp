// SPDX-License-Identifier: GPL-3.0-or-later
// The recording of all benchmarks of `spatial`: one 40 mm stroke per second at 50 mm/s, alternately back and
// forth.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace tacto::bench {

inline constexpr double kRate_hz = 10000;
inline constexpr double kQuantum_m = 1e-6;
inline constexpr double kPitch_m = 1e-6;
inline constexpr std::size_t kFramesPerSecond = 10000;
inline constexpr std::size_t kStrokeFrames = 8000;  // 40 mm at 50 mm/s, then 0.2 s of rest
inline constexpr double kStroke_m = 40e-3;

/// Position of a finger on an encoder of 1 um, and the force of a surface with lines at 2 and 8 /mm, with
/// drift and some noise. One value per frame, at 10 kHz.
struct Workload {
  std::vector<double> position_m, force_n;
};

/// Position within a stroke: the speed varies by a tenth, three times.
inline double way_m(double t_s) {
  constexpr double kWavers_hz = 3 / 0.8;
  const double turn = 2 * std::numbers::pi * kWavers_hz;
  return 0.05 * (t_s + 0.1 * std::sin(turn * t_s) / turn);
}

/// The same numbers on every machine and in scipy_columns.py: 0 ... 1, evenly distributed.
inline double hashed(std::size_t i) {
  return std::fmod(static_cast<double>(i % 65536) * 0.6180339887498949, 1.0);
}

inline Workload workload(std::size_t seconds) {
  Workload made;
  for (std::size_t i = 0; i < seconds * kFramesPerSecond; ++i) {
    const std::size_t stroke = i / kFramesPerSecond, frame = i % kFramesPerSecond;
    const double way = frame < kStrokeFrames ? way_m(static_cast<double>(frame) / kRate_hz) : kStroke_m;
    const double exact_m = stroke % 2 == 0 ? way : kStroke_m - way;
    const double turn = 2 * std::numbers::pi * exact_m * 1e3;
    made.position_m.push_back(std::round(exact_m / kQuantum_m) * kQuantum_m);
    made.force_n.push_back(0.3 + 1e-3 * static_cast<double>(i) / kRate_hz + 0.05 * std::sin(2 * turn) +
                           0.02 * std::sin(8 * turn) + 0.005 * (hashed(i) - 0.5));
  }
  return made;
}

}  // namespace tacto::bench

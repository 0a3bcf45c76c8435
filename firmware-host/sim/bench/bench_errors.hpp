// SPDX-License-Identifier: GPL-3.0-or-later
// Intentional differences between the emulated bench and the device's description, as test cases for
// calibration.
#pragma once

#include "firmware-host/sim/physics/known_force.hpp"

namespace tacto::firmware_host {

/// A gain of 1.02 gives 2 % more volts, codes or counts than the nominal scale of the device. Known loads act
/// on the load cell permanently; the high-pass of the piezo removes them.
struct BenchErrors {
  double sensor_gain = 1, cell_gain = 1, encoder_gain = 1;
  double cell_zero_n = 0;  ///< both axes without load
  double weight_n = 0;     ///< known, down on the tray
  double pull_n = 0;       ///< known, along +x
  double mains_v = 0;      ///< peak at the converter of the piezo, 50 Hz; a third of it at 150 Hz
  double clock_ppm = 0;    ///< error of the device's clock; positive: fast
};

/// Mains pick-up, in volts.
inline double mains_at(double mains_v, double time_s) {
  const double turns = 50 * time_s;
  return mains_v == 0 ? 0 : mains_v * (sine_of_turns(turns) + sine_of_turns(3 * turns) / 3);
}

}  // namespace tacto::firmware_host

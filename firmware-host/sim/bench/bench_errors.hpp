// SPDX-License-Identifier: GPL-3.0-or-later
// What the emulated bench does otherwise than its device says, so that calibration has something to find.
#pragma once

#include "firmware-host/sim/physics/known_force.hpp"

namespace tacto::firmware_host {

/// A gain of 1.02 gives 2 % more volts, codes or counts than the device's own scale tells. Known loads act on
/// the load cell without end: the piezo, behind its high-pass, knows nothing of them.
struct BenchErrors {
  double sensor_gain = 1, cell_gain = 1, encoder_gain = 1;
  double cell_zero_n = 0;  ///< both axes at rest
  double weight_n = 0;     ///< known, down on the tray
  double pull_n = 0;       ///< known, along +x
  double mains_v = 0;      ///< peak at the converter of the piezo, 50 Hz; a third of it at 150 Hz
  double clock_ppm = 0;    ///< how much the device's clock is fast
};

/// Mains pick-up, in volts.
inline double mains_at(double mains_v, double time_s) {
  const double turns = 50 * time_s;
  return mains_v == 0 ? 0 : mains_v * (sine_of_turns(turns) + sine_of_turns(3 * turns) / 3);
}

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// The variants of the emulated tray: effects that a transducer may have beyond its model.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"

namespace tacto::analysis {

struct Tray {
  std::string name;
  firmware_host::TrayPhysics physics;
};

struct Trays {
  schema::Transducer transducer;  ///< of the emulated device
  std::string simulated;          ///< origin of the simulation
  std::vector<Tray> trays;
};

/// The trays of a `sim:` URI. If it sets hysteresis, a second mode, a finger's load or a reconstruction
/// filter: one tray with exactly these. Otherwise: ideal; hysteresis of 16 % (Wiertlewski 2011, Figure 7); a
/// second mode at 800 Hz (section III-B), or a fifth above the lowest that the transducer can have; a
/// finger's load; all three. Errors: those of parse_sim_parameters and read_transducer.
schema::Result<Trays> trays_of(const std::string& uri);

}  // namespace tacto::analysis

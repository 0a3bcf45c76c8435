// SPDX-License-Identifier: GPL-3.0-or-later
// The trays that one drive moves: what a transducer may have beside its model.
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
  std::string simulated;          ///< by what
  std::vector<Tray> trays;
};

/// Of a `sim:` URI. Where it names hysteresis, a second mode, a finger's load or a reconstruction filter: one
/// tray, that one. Else: ideal; hysteresis of 16 % (Wiertlewski 2011, Figure 7); a second
/// mode at 800 Hz (section III-B), or a fifth above the lowest that the transducer can have; a finger's load;
/// all three. Errors: as parse_sim_parameters and read_transducer.
schema::Result<Trays> trays_of(const std::string& uri);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// What the emulated device says of itself.
#pragma once

#include <string_view>
#include <vector>

#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/sim/device/sim_run.hpp"

namespace tacto::firmware_host {

/// tangential_force (the transducer's output, V), position (encoder, counts; or LVDT, m), normal_force and
/// net_force (load cell, N), and where a known force pulls applied_force (reference cell, N).
std::vector<wire::Channel> sim_channels(const SimRun& run, const SimParameters& parameters);
/// Plain numbers of the quantity `signal`.
std::vector<wire::Channel> counter_channels(int count);
/// By what it is simulated, what its frames are then of, its transducer, its surface.
std::vector<wire::Note> sim_notes(const SimParameters& parameters, std::string_view surface);
/// Name, serial, firmware, features and limits; clock and rates are the board's.
wire::Welcome sim_welcome(const SimParameters& parameters, const schema::Transducer& transducer);

}  // namespace tacto::firmware_host

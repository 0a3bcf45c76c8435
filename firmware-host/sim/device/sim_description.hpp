// SPDX-License-Identifier: GPL-3.0-or-later
// The description of the emulated device.
#pragma once

#include <string_view>
#include <vector>

#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/sim/device/sim_run.hpp"

namespace tacto::firmware_host {

/// tangential_force (the transducer's output, V), position (encoder, counts; or LVDT, m), normal_force and
/// net_force (load cell, N), and with a known force applied_force (reference cell, N).
std::vector<wire::Channel> sim_channels(const SimRun& run, const SimParameters& parameters);
/// Plain numbers of the quantity `signal`.
std::vector<wire::Channel> counter_channels(int count);
/// The simulation, the content of its frames, its transducer, its surface.
std::vector<wire::Note> sim_notes(const SimParameters& parameters, std::string_view surface);
/// Name, serial, firmware, features and limits; the board sets clock and rates.
wire::Welcome sim_welcome(const SimParameters& parameters, const schema::Transducer& transducer);

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of a status about ticks, recorder, loop and the clients that have to stay; names as in
// CONTROL.md.
#pragma once

#include "data-schema/control/control.hpp"
#include "playback/control/stay_watch.hpp"
#include "playback/host-loop/host_loop.hpp"
#include "playback/player/flight_recorder.hpp"
#include "playback/player/player.hpp"

namespace tacto::playback {

/// `not_recorded`: ticks that are missing in the session; they are counted as lost.
void add_ticks(schema::ControlFields& fields, const TickView& view, std::uint64_t not_recorded);
/// Of a scene of forces: place and force of each axis.
void add_forces(schema::ControlFields& fields, const TickView& view, const schema::SessionForces& forces);
/// If the device's flags report limited ticks: what the limits removed, in dB, live, or why it is unknown;
/// and the command that reports it for each stroke.
void add_limits(schema::ControlFields& fields, const PlayerStatus& status);
/// The clients that have to stay, if requested.
void add_stay(schema::ControlFields& fields, const StayRules& rules);
void add_recorder(schema::ControlFields& fields, const RecorderCounts& counts);
void add_loop(schema::ControlFields& fields, const HostLoopStatus& loop);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// What a status says of ticks, recorder and loop, and who has to stay; names as in CONTROL.md.
#pragma once

#include "data-schema/control/control.hpp"
#include "playback/host-loop/host_loop.hpp"
#include "playback/player/flight_recorder.hpp"
#include "playback/player/player.hpp"
#include "playback/session/stay_watch.hpp"

namespace tacto::playback {

/// `not_recorded`: ticks that did not get into the session, which are lost too.
void add_ticks(schema::ControlFields& fields, const TickView& view, std::uint64_t not_recorded);
/// Where the device's flags tell that limits took something away: how much, in dB, live, or why it is not
/// known; and the command that tells it by stroke.
void add_limits(schema::ControlFields& fields, const PlayerStatus& status);
/// Who has to stay, where that was asked for.
void add_stay(schema::ControlFields& fields, const StayRules& rules);
void add_recorder(schema::ControlFields& fields, const RecorderCounts& counts);
void add_loop(schema::ControlFields& fields, const HostLoopStatus& loop);

}  // namespace tacto::playback

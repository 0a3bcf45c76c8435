// SPDX-License-Identifier: GPL-3.0-or-later
// What a status says of ticks, recorder and loop; names as in CONTROL.md.
#pragma once

#include "data-schema/control.hpp"
#include "playback/daemon/flight_recorder.hpp"
#include "playback/daemon/host_loop.hpp"
#include "playback/daemon/tick_view.hpp"

namespace tacto::playback {

/// `not_recorded`: ticks that did not get into the session, which are lost too.
void add_ticks(schema::ControlFields& fields, const TickView& view, std::uint64_t not_recorded);
void add_recorder(schema::ControlFields& fields, const RecorderCounts& counts);
void add_loop(schema::ControlFields& fields, const HostLoopStatus& loop);

}  // namespace tacto::playback

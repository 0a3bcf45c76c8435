// SPDX-License-Identifier: GPL-3.0-or-later
// What the limits removed from the drive in a session.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/session/session.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// The flags of ticks whose drive the limits of amplitude, slew or energy reduced.
inline constexpr std::uint32_t kEveryLimit =
    wire::kTickAmplitudeLimited | wire::kTickSlewLimited | wire::kTickEnergyLimited;

/// A tick as LimitTally needs it: the recorded drive, its flags, and the unlimited drive, V.
core::TickOutput limited_tick(float drive_v, float unlimited_v, std::uint32_t flags);

/// Calls back for each tick, in order, with the unlimited drive of the kernel. If no tick is flagged as
/// limited, that is the recorded drive; otherwise the session is replayed (replay_session). Errors: as
/// replay_session; unsuitable, if ticks are missing, the file is damaged, or the replayed drive differs: then
/// the unlimited drive is unknown.
schema::Result<void> read_unlimited(
    const std::string& session,
    const std::function<void(const schema::SessionTick& tick, float unlimited_v)>& listener,
    const std::function<void(double)>& progress = {});

/// The same for every tick; none if unknown. Returns why it is not known for all ticks, if so: then it is
/// known up to the first difference in the replayed drive. Errors: as SessionReader::open. `progress`
/// receives fractions.
schema::Result<std::optional<schema::Error>> read_unlimited_where_known(
    const std::string& session,
    const std::function<void(const schema::SessionTick& tick, std::optional<float> unlimited_v)>& listener,
    const std::function<void(double)>& progress = {});

/// The tally of the whole session. Errors: as read_unlimited().
schema::Result<LimitTally> tally_session(const std::string& session);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// What the limits took away in a session.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/session/session.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// The flags of a tick from whose drive amplitude, slew or energy took something.
inline constexpr std::uint32_t kEveryLimit =
    wire::kTickAmplitudeLimited | wire::kTickSlewLimited | wire::kTickEnergyLimited;

/// A tick as LimitTally takes it: the recorded drive and its flags, and what was wished, V.
core::TickOutput limited_tick(float drive_v, float unlimited_v, std::uint32_t flags);

/// Hears of every tick in its order what the kernel wished before the limits. Where no tick is flagged as
/// limited that is the drive; else the session is replayed (replay_session). Errors: as replay_session;
/// unsuitable, where ticks are missing, the file is damaged, or the replayed drive is another one: then it is
/// not known.
schema::Result<void> hear_wishes(
    const std::string& session,
    const std::function<void(const schema::SessionTick& tick, float unlimited_v)>& listener,
    const std::function<void(double)>& progress = {});

/// The same of every tick: none where it is not known. Gives why it is not known of all, where it is not:
/// then it is told up to where the replayed drive becomes another one. Errors: as SessionReader::open.
/// `progress` hears fractions.
schema::Result<std::optional<schema::Error>> hear_every_wish(
    const std::string& session,
    const std::function<void(const schema::SessionTick& tick, std::optional<float> unlimited_v)>& listener,
    const std::function<void(double)>& progress = {});

/// Of the whole session. Errors: as hear_wishes().
schema::Result<LimitTally> tally_session(const std::string& session);

}  // namespace tacto::playback

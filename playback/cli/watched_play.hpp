// SPDX-License-Identifier: GPL-3.0-or-later
// `ctl play --watch`: plays for as long as the command runs.
#pragma once

#include <functional>
#include <optional>

#include "data-schema/report/report.hpp"
#include "playback/control/control_connection.hpp"

namespace tacto::playback {

/// Arms such that the drive falls if this process ends or stops (`while_connected`, `dead_man_s`), plays, and
/// stays connected until it is interrupted, `time_s` is over, or the session ends in another way; then it
/// stops the drive and disarms. `show` receives each status, four a second. Errors: as ask(); unsupported: a
/// daemon without `while_connected`.
schema::Result<cli::Report> watched_play(ControlConnection& connection, std::optional<double> time_s,
                                         const std::function<void(const schema::ControlFields&)>& show);

}  // namespace tacto::playback

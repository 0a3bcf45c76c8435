// SPDX-License-Identifier: GPL-3.0-or-later
// What the limits removed, in the reports of the verbs.
#pragma once

#include <optional>

#include "data-schema/report/report.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// Adds `removed_by_limits_db` and in how many ticks each limit acted; or `removed_by_limits`: none, or
/// unknown.
void add_removed(cli::Report& report, const std::optional<LimitTally>& limits);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// What the limits took, as the verbs tell it.
#pragma once

#include <optional>

#include "data-schema/report/report.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// `removed_by_limits_db` and which limits acted in how many ticks; `removed_by_limits` none, or unknown.
void add_removed(cli::Report& report, const std::optional<LimitTally>& limits);

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/limits_report.hpp"

namespace tacto::playback {

void add_removed(cli::Report& report, const std::optional<LimitTally>& limits) {
  if (!limits) {
    report.add("removed_by_limits", "unknown");
    return;
  }
  if (limits->removed_any())
    report.add("removed_by_limits_db", limits->removed_db());
  else
    report.add("removed_by_limits", "none");
  report.add("amplitude_limited_ticks", limits->amplitude_limited())
      .add("slew_limited_ticks", limits->slew_limited());
}

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// The period of a looped texture.
#pragma once

#include "data-schema/report/report.hpp"

namespace tacto::playback {

/// Adds `loop_period_m` and `loop_seam_m`; nothing if there is no loop (a period of 0).
inline void add_loop(cli::Report& report, double period_m, double seam_m) {
  if (period_m > 0) report.add("loop_period_m", period_m).add("loop_seam_m", seam_m);
}

}  // namespace tacto::playback

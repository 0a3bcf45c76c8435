// SPDX-License-Identifier: GPL-3.0-or-later
// How a verb ends that a signal stopped.
#pragma once

#include <csignal>

#include "data-schema/report/talk.hpp"

namespace tacto::analysis {

/// Ends the process as SIGINT ends any, so that shells see no exit code of ours. To be called once everything
/// is cleared up that the work held, and no StopSignals stands any more.
inline void end_as_stopped() {
  cli::talk("tactograph: stopped before the end; nothing is written\n");
  std::signal(SIGINT, SIG_DFL);
  std::raise(SIGINT);
}

}  // namespace tacto::analysis

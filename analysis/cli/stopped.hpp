// SPDX-License-Identifier: GPL-3.0-or-later
// Ends a verb that was stopped by a signal.
#pragma once

#include <csignal>

#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {

/// Ends the process by SIGINT, so that a shell sees the signal and not an exit code. Call it after everything
/// that the work used is released and no StopSignals object exists.
inline void end_as_stopped() {
  cli::write_message("tactograph: stopped before the end; no result is written\n");
  std::signal(SIGINT, SIG_DFL);
  std::raise(SIGINT);
}

}  // namespace tacto::analysis

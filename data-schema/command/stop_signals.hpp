// SPDX-License-Identifier: GPL-3.0-or-later
// Signals that control long work in progress.
#pragma once

#include <csignal>
#include <cstddef>

namespace tacto::cli {

/// While the object exists, SIGINT and SIGTERM ask to stop, also SIGHUP (the terminal was closed), and
/// SIGUSR1 sets a mark; before and after, signals act as usual. A second SIGINT ends the process at once. One
/// object at a time.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  /// Also after the object, until the next one.
  static bool stop_asked();
  /// Marks asked for since the last call.
  std::size_t take_marks();

 private:
  static constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};
  struct sigaction before_[4]{};
};

}  // namespace tacto::cli

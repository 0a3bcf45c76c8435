// SPDX-License-Identifier: GPL-3.0-or-later
// What people ask of long work under way by signals.
#pragma once

#include <csignal>
#include <cstddef>

namespace tacto::cli {

/// While it lives, SIGINT and SIGTERM ask to stop, SIGHUP too (the terminal went), and SIGUSR1 marks; before
/// and after, signals do what they did. A second SIGINT ends the process at once. One at a time.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  bool stop_asked() const;
  /// Marks asked for since the last call.
  std::size_t take_marks();

 private:
  static constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};
  struct sigaction before_[4]{};
};

}  // namespace tacto::cli

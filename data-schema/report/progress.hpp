// SPDX-License-Identifier: GPL-3.0-or-later
// Progress on stderr for work that takes over a second; quick work stays silent.
#pragma once

#include <chrono>
#include <string>

namespace tacto::cli {

/// Shows "recording  42 %" on a terminal once a second has passed, redrawn in place. Elsewhere it prints
/// nothing, or with show_progress_lines() a line every 5 s.
class Progress {
 public:
  explicit Progress(std::string task);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Clears the line.
  ~Progress();
  /// 0 to 1. Cheap: it may be called at any rate.
  void update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  std::string task_;
  bool terminal_, silent_;
  bool shown_ = false;
  Clock::time_point next_;
};

/// For the option --progress: progress is also printed where stderr is no terminal. Call it before the work
/// begins.
void show_progress_lines();

}  // namespace tacto::cli

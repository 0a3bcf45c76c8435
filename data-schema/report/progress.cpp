// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "data-schema/report/terminal.hpp"

namespace tacto::cli {

using namespace std::chrono_literals;

namespace {
bool shows_lines = false;
}

void show_progress_lines() {
  shows_lines = true;
}

Progress::Progress(std::string task)
    : task_(std::move(task)),
      terminal_(isatty(STDERR_FILENO) == 1),
      silent_(!terminal_ && !shows_lines),
      next_(Clock::now() + 1s) {}

Progress::~Progress() {
  if (shown_ && terminal_) write_message("\r\033[K");
}

void Progress::update(double fraction) {
  if (silent_) return;
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? 100ms : 5000ms);
  shown_ = true;
  write_message(
      fmt::format("{}{}  {:3.0f} %{}", terminal_ ? "\r" : "", task_, 100 * fraction, terminal_ ? "" : "\n"));
  std::fflush(stderr);
}

}  // namespace tacto::cli

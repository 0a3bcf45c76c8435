// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/stop_signals.hpp"

#include <atomic>
#include <cstdlib>
#include <iterator>

namespace tacto::cli {
namespace {

// A signal handler can reach only global variables.
std::atomic<bool> stop_is_asked{false};
std::atomic<std::size_t> marks_asked{0};
static_assert(std::atomic<std::size_t>::is_always_lock_free);

void note(int signal) {
  if (signal == SIGUSR1)
    marks_asked.fetch_add(1);
  else if (stop_is_asked.exchange(true) && signal == SIGINT)
    std::_Exit(128 + SIGINT);
}

}  // namespace

StopSignals::StopSignals() {
  stop_is_asked = false;
  marks_asked = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignals::stop_asked() {
  return stop_is_asked;
}

std::size_t StopSignals::take_marks() {
  return marks_asked.exchange(0);
}

}  // namespace tacto::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/gadget_loop.hpp"

#include <fmt/format.h>

#include "firmware-host/link/wire_words.hpp"

namespace tacto::firmware_host {
namespace {

constexpr std::size_t kMostWaiting = 1 << 20;     // bytes for the host: some seconds of frames
constexpr std::uint64_t kTicksBetweenPolls = 32;  // an eighth of the core's ring
constexpr std::chrono::milliseconds kIdleWake{
    50};  // without ticks, only the host and signals need a response

}  // namespace

void GadgetLoop::run(const std::function<bool()>& stopped) {
  while (!stopped()) {
    exchange();
    if (board_.ticking()) {
      tick();
    } else {
      pacer_.stop();
      link_.wait_until(TickPacer::Clock::now() + kIdleWake);
    }
  }
}

void GadgetLoop::exchange() {
  if (link_.waiting() > kMostWaiting) return;
  const std::size_t before = board_.from_host().size();
  link_.take_received(board_.from_host());
  if (board_.from_host().size() > before) drive_.heard();
  board_.poll();
  if (!board_.to_host().empty()) link_.send(board_.to_host());
  board_.to_host().clear();
}

void GadgetLoop::tick() {
  const auto now = TickPacer::Clock::now();
  if (!pacer_.running()) pacer_.start(board_.period_s(), now);
  const std::uint64_t ticks = std::min(due(), kTicksBetweenPolls);
  if (ticks == 0) return link_.wait_until(pacer_.next_wake(now));
  for (std::uint64_t i = 0; i < ticks && board_.ticking(); ++i) step();
  pacer_.did(ticks);
}

void GadgetLoop::step() {
  const double period_s = board_.period_s();
  board_.step();
  const core::DriveSupervisor& supervisor = board_.supervisor();
  if (const auto fall = drive_.observe(supervisor.state(), board_.drive_v(), period_s))
    say_(fmt::format(
        "fault: {}; the last bytes from the host came {:.2f} ms before it; the drive went from {:.3f} V to "
        "{:.3f} V within {:.2f} ms",
        words_of(supervisor.fault(), supervisor.fault_detail()).what, 1e3 * fall->silent_s, fall->from_v,
        fall->left_v, 1e3 * fall->fell_s));
  if (drive_.rose()) say_("the drive increases for the first time since the fault");
}

std::uint64_t GadgetLoop::due() {
  double slipped_s = 0;
  const std::uint64_t ticks = pacer_.due(TickPacer::Clock::now(), slipped_s);
  if (slipped_s > 0 && !std::exchange(told_slow_, true))
    say_(
        fmt::format("the board was delayed, or this machine is too slow for it: it continues {:.2f} s behind "
                    "the clock (printed once)",
                    slipped_s));
  return ticks;
}

}  // namespace tacto::firmware_host

// SPDX-License-Identifier: GPL-3.0-or-later
// Which tick received which command, so that a replay can repeat the commands at the same ticks.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "data-schema/session/session.hpp"

namespace tacto::playback {

/// Gives a session's commands to a device that is replayed tick by tick. The upload is given at once; arming
/// waits for the first tick, a steering command for the tick whose flags count it. An upload after arming is
/// given directly before the change that uses it, because then the device certainly had it. An upload that no
/// change uses has no effect.
class SessionCommands {
 public:
  using Obey = std::function<void(const schema::SessionCommand& command)>;

  /// Call in the order of the session, before the ticks that received the command. Precondition: its frame
  /// is_frame().
  void hand(const schema::SessionCommand& command, const Obey& obey);
  /// Gives the commands that were received since the previous tick. Ticks from 0 on, none missing.
  void before(const schema::SessionTick& tick, const Obey& obey);

 private:
  struct Steering {
    std::vector<schema::SessionCommand> upload;  // the upload for this command
    schema::SessionCommand command;
  };
  std::optional<schema::SessionCommand> arming_;
  std::deque<Steering> waiting_;
  std::vector<schema::SessionCommand> next_;  // upload since then, for the next change
  std::uint8_t steered_ = 0;
};

/// The heartbeats of the host in a replay: always in time, except before the first tick in fault, where the
/// host is silent for the watchdog's time. This holds for every cause of the fault: a silence that ends in
/// the same tick does not change another cause.
class HostBeats {
 public:
  /// One of the commands contains the time of the device's watchdog.
  void see(const schema::SessionCommand& command, double rate_hz);
  void see(const schema::SessionTick& tick);
  /// Whether there is a heartbeat before this tick. Call after see() of the session's first fault.
  bool beats_before(std::uint64_t tick) const;
  /// How many ticks after a tick have to be seen before beats_before() of it is known; 0 after a fault.
  std::uint64_t looks_ahead() const { return fault_ == kNever ? watchdog_ticks_ + 1 : 0; }

 private:
  static constexpr std::uint64_t kNever = UINT64_MAX;
  std::uint64_t fault_ = kNever, watchdog_ticks_ = 0;
};

}  // namespace tacto::playback

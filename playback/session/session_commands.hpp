// SPDX-License-Identifier: GPL-3.0-or-later
// Which tick took which command: what a play that is computed again has to hear, and when.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "data-schema/session/session.hpp"

namespace tacto::playback {

/// A session's commands for a device that is given its ticks. The upload goes in at once; arming waits for
/// the first tick, steering for the tick that counts it in its flags. What is uploaded after arming goes in
/// right before the change that is to it: then the device is known to have taken it. What no change is to did
/// nothing.
class SessionCommands {
 public:
  using Obey = std::function<void(const schema::SessionCommand& command)>;

  /// In the order of the session, each before the ticks that took it. Precondition: its frame is_frame().
  void hand(const schema::SessionCommand& command, const Obey& obey);
  /// What this tick has taken since the one before it. Ticks from 0 on, without a hole.
  void before(const schema::SessionTick& tick, const Obey& obey);

 private:
  struct Steering {
    std::vector<schema::SessionCommand> upload;  // that belongs to it
    schema::SessionCommand command;
  };
  std::optional<schema::SessionCommand> arming_;
  std::deque<Steering> waiting_;
  std::vector<schema::SessionCommand> next_;  // what was uploaded since, for a change to come
  std::uint8_t steered_ = 0;
};

/// When a host is heard that plays a session again: always in time, but before the first tick in fault, where
/// it is as silent as it was. Whatever the fault's cause: a silence that ends in the same tick changes
/// nothing about another one.
class HostBeats {
 public:
  /// The device's watchdog stands in one of the commands.
  void see(const schema::SessionCommand& command, double rate_hz);
  void see(const schema::SessionTick& tick);
  /// Whether it beats before this tick, the first fault of the whole session seen.
  bool beats_before(std::uint64_t tick) const;
  /// So many ticks from a tick on have to be seen before it is known whether the host beats before it; none
  /// once there was a fault.
  std::uint64_t looks_ahead() const { return fault_ == kNever ? watchdog_ticks_ + 1 : 0; }

 private:
  static constexpr std::uint64_t kNever = UINT64_MAX;
  std::uint64_t fault_ = kNever, watchdog_ticks_ = 0;
};

}  // namespace tacto::playback

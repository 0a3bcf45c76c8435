// SPDX-License-Identifier: GPL-3.0-or-later
// What the limits remove during a playback.
#pragma once

#include <array>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "data-schema/session/session.hpp"
#include "playback/model/limit_tally.hpp"
#include "playback/session/session_board.hpp"
#include "playback/session/session_commands.hpp"

namespace tacto::playback {

/// RMS of unlimited - delivered drive re RMS of the unlimited drive, dB, as LimitTally computes it for a
/// session. None if the limits removed nothing in these ticks.
struct LimitsTook {
  std::optional<double> db;              ///< since arming
  std::optional<double> last_second_db;  ///< of the newest known second: 0.9 to 1 s of ticks
  std::string unknown;                   ///< why it is unknown from some tick on; then both are none
};

/// A device reports its drive and flags, not the kernel's drive before the limits. So a second device of the
/// same core, without limits, gets the same commands and counts while they are recorded (session_limits.hpp
/// has the definition, and does the same for a session; the figures agree). It follows the ticks with a delay
/// of the device's watchdog time, because only then it is known that the host was not silent for too long.
/// Unknown: from missing ticks or commands on, also those missing in the file; if
/// the drive of the second device differs before a limit was reached, or it refuses a command. One thread
/// calls add_command(), take() and end(), which allocate, so not that of the tick. Any thread may call
/// figures().
class LiveLimits {
 public:
  /// `profile_samples`: the number that the device holds.
  LiveLimits(const schema::SessionHeader& header, std::size_t profile_samples);

  /// Call in the order of the session, before the ticks that received the command. Precondition: its frame
  /// is_frame().
  void add_command(const schema::SessionCommand& command);
  void take(std::span<const schema::SessionTick> ticks);
  /// A part of the session is missing in its file: from now on the figures are unknown, as they are from the
  /// file.
  void lose(const std::string& what);
  /// Call after the last tick: evaluates the remaining ticks, and removes the second device.
  void end();
  LimitsTook figures() const;

 private:
  static constexpr std::size_t kParts = 10;  // of the last second
  void follow(std::uint64_t held_back);
  void play(const schema::SessionTick& tick);
  void obey(const schema::SessionCommand& command);
  void give_up(std::string why);
  void count(const schema::SessionTick& tick, float unlimited_v);
  void publish();

  double rate_hz_;
  std::unique_ptr<SessionBoard> board_;  // none after the end
  SessionCommands commands_;
  HostBeats beats_;
  std::deque<schema::SessionTick> waiting_;
  std::uint64_t expected_ = 0;
  bool limited_ = false;
  LimitTally whole_;
  std::array<LimitTally, kParts> parts_;
  std::uint64_t part_ = 0;  // index since arming of the part that is being filled
  mutable std::mutex mutex_;
  LimitsTook reported_;
};

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// What the limits take away in a play that goes on.
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

/// RMS of wished - delivered drive re RMS of the wished one, dB, as LimitTally tells it of a session. None
/// where the limits took nothing of these ticks.
struct LimitsTook {
  std::optional<double> db;              ///< since arming
  std::optional<double> last_second_db;  ///< of the newest second that is known: 0.9 to 1 s of ticks
  std::string unknown;                   ///< why it is not known from some tick on; then both are none
};

/// A device tells the drive and flags, not what its kernel wished. So a second device of the same core, whose
/// limits are lifted, is given the same commands and counts as they are recorded (session_limits.hpp has the
/// definition, and does the same of a session; the figures agree). It follows the ticks by the device's
/// watchdog: only then it is known that the host was not too silent.
/// Not known: from ticks or commands on that are missing, in the file too; of a contact gate whose ticks do
/// not tell the touch (before protocol 1.2); where the second device does otherwise than the first one before
/// a limit was reached, or refuses a command. One thread calls hear(), take() and end(), which allocate:
/// never the tick's. told() is for any.
class LiveLimits {
 public:
  /// `profile_samples`: as many as the device holds.
  LiveLimits(const schema::SessionHeader& header, std::size_t profile_samples);

  /// In the order of the session, before the ticks that took it. Precondition: its frame is_frame().
  void hear(const schema::SessionCommand& command);
  void take(std::span<const schema::SessionTick> ticks);
  /// Something of the session did not get into its file: from now on nothing is known, as of the file.
  void lose(const std::string& what);
  /// No tick comes any more: tells of all that came. The second device is gone then.
  void end();
  LimitsTook told() const;

 private:
  static constexpr std::size_t kParts = 10;  // of the last second
  void follow(std::uint64_t held_back);
  void play(const schema::SessionTick& tick);
  void obey(const schema::SessionCommand& command);
  void give_up(std::string why);
  void count(const schema::SessionTick& tick, float unlimited_v);
  void tell();

  double rate_hz_;
  bool tells_touch_;
  std::unique_ptr<SessionBoard> board_;  // none once it is over
  SessionCommands commands_;
  HostBeats beats_;
  std::deque<schema::SessionTick> waiting_;
  std::uint64_t expected_ = 0;
  bool limited_ = false;
  LimitTally whole_;
  std::array<LimitTally, kParts> parts_;
  std::uint64_t part_ = 0;  // that is being filled, of all since arming
  mutable std::mutex mutex_;
  LimitsTook told_;
};

}  // namespace tacto::playback

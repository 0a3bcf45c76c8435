// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/session_replay.hpp"

#include <fmt/format.h>

#include <bit>
#include <memory>

#include "firmware-host/link/wire_words.hpp"
#include "playback/session/session_board.hpp"
#include "playback/session/session_commands.hpp"
#include "playback/session/session_rows.hpp"
#include "playback/session/upload_watch.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using schema::SessionCommand;
using schema::SessionTick;

// What a replay needs to know of the whole session before its first tick.
struct Overview {
  HostBeats beats;
  std::uint64_t lost = 0;
  schema::SessionEnding ending = schema::SessionEnding::unread;
  std::optional<std::uint64_t> damaged_at;
  UploadWatch upload;
  bool ticks = false;  // whether there are any
};

Result<Overview> overview_of(const std::string& name) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  Overview seen;
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block)) {
      seen.ticks = true;
      for (const SessionTick& tick : *ticks) seen.beats.see(tick);
    }
    if (const auto* loss = std::get_if<schema::SessionLoss>(&*block)) seen.lost += loss->count;
    if (const auto* end = std::get_if<schema::SessionEnd>(&*block)) seen.lost = end->lost_ticks;
    const auto* command = std::get_if<SessionCommand>(&*block);
    if (command == nullptr) continue;
    seen.upload.see(*command);
    if (!is_frame(command->frame))
      return fail(ErrorKind::malformed, "a command in it is not a frame of the wire", reader->path());
    seen.beats.see(*command, reader->header().rate_hz);
  }
  seen.ending = reader->ending();
  if (seen.ending == schema::SessionEnding::damaged) seen.damaged_at = reader->sound_bytes();
  return seen;
}

class SessionPlayer {
 public:
  SessionPlayer(const schema::SessionHeader& header, const HostBeats& beats,
                const UnlimitedListener& listener, const SceneListener& scene_listener)
      : board_(header), beats_(beats), listener_(listener), scene_listener_(scene_listener) {
    if (listener_) unlimited_ = std::make_unique<SessionBoard>(header, BoardLimits::lifted);
  }

  void hand(const SessionCommand& command) { commands_.hand(command, obey_); }
  void play(const std::vector<SessionTick>& ticks) {
    for (const SessionTick& tick : ticks) {
      if (is_over()) return;
      take(tick);
    }
  }

  bool is_over() const { return refused_.has_value() || outcome_.first_difference || outcome_.lost_at; }
  const std::optional<std::string>& refused() const { return refused_; }
  const ReplayOutcome& outcome() const { return outcome_; }
  const core::SceneKernel& scene() const { return board_.scene(); }

 private:
  void obey(const SessionCommand& command) {
    if (refused_) return;
    const auto answer = board_.send_frame(command.frame);
    if (unlimited_) unlimited_->send_frame(command.frame);
    if (answer && answer->code == wire::AnswerCode::ok) return;
    const auto words = answer ? firmware_host::words_of(answer->code, answer->detail).what : "no answer";
    refused_ = fmt::format("{} is refused: {}", firmware_host::to_string(type_of(command)), words);
  }
  void take(const SessionTick& tick) {
    if (tick.tick != outcome_.ticks) {
      outcome_.lost_at = outcome_.ticks;
      return;
    }
    if (tick.tick == 0) {
      board_.rest_at(tick);
      if (unlimited_) unlimited_->rest_at(tick);
    }
    commands_.before(tick, obey_);
    const bool beats = beats_.beats_before(tick.tick);
    if (beats) board_.say(wire::Heartbeat{});
    const float drive_v = board_.tick(tick);
    if (tick.axes > 0)
      compare_forces(tick);
    else
      compare(tick, drive_v);
    if (unlimited_) report_unlimited(tick, beats);
  }
  void report_unlimited(const SessionTick& tick, bool beats) {
    if (beats) unlimited_->say(wire::Heartbeat{});
    const float unlimited_v = unlimited_->tick(tick);
    if (!outcome_.first_difference) listener_(tick, unlimited_v);
  }
  // Of the first axis that differs.
  void compare_forces(const SessionTick& tick) {
    ++outcome_.ticks;
    for (std::size_t i = 0; i < tick.axes; ++i)
      if (std::bit_cast<std::uint32_t>(board_.force_n()[i]) !=
          std::bit_cast<std::uint32_t>(tick.force_n[i])) {
        outcome_.first_difference = {tick.tick, tick.force_n[i], board_.force_n()[i], "n"};
        return;
      }
    if (scene_listener_) scene_listener_(board_.scene());
  }
  void compare(const SessionTick& tick, float replayed_v) {
    ++outcome_.ticks;
    if (std::bit_cast<std::uint32_t>(replayed_v) == std::bit_cast<std::uint32_t>(tick.drive_v)) return;
    outcome_.first_difference = {tick.tick, tick.drive_v, replayed_v, "v"};
  }

  SessionBoard board_;
  std::unique_ptr<SessionBoard> unlimited_;  // if the caller needs its drive
  HostBeats beats_;
  const UnlimitedListener& listener_;
  const SceneListener& scene_listener_;
  SessionCommands commands_;
  SessionCommands::Obey obey_ = [this](const SessionCommand& command) { obey(command); };
  std::optional<std::string> refused_;
  ReplayOutcome outcome_;
};

// A command is stored at its time of sending; a tick that received it may be stored earlier, because ticks
// are delayed on the link. There are few commands, so all are read first.
Result<void> hand_over_commands(const std::string& name, SessionPlayer& player) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  while (const auto block = reader->next())
    if (const auto* command = std::get_if<SessionCommand>(&*block)) player.hand(*command);
  return {};
}

// In a damaged file a part of the upload may be behind the damage.
Result<void> check_replayable(const Overview& seen, const schema::SessionReader& reader) {
  const std::string missing = seen.upload.missing();
  if (!missing.empty() && seen.ticks && !seen.damaged_at)
    return fail(
        ErrorKind::unsuitable,
        fmt::format(
            "lacks {}: it could not be written (was the disk full?), so the drive can't be computed again",
            missing),
        reader.path(), "tactograph session can export its ticks");
  return {};
}

}  // namespace

Result<ReplayOutcome> replay_session(const std::string& name, const std::function<void(double)>& progress,
                                     const UnlimitedListener& listener, const SceneListener& scene_listener,
                                     const SceneListener& at_end) {
  const auto seen = overview_of(name);
  TACTO_TRY(seen);
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  TACTO_TRY(check_replayable(*seen, *reader));
  SessionPlayer player(reader->header(), seen->beats, listener, scene_listener);
  TACTO_TRY(hand_over_commands(name, player));
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block)) player.play(*ticks);
    if (player.is_over()) break;
    if (progress) progress(part_read(*reader));
  }
  if (player.refused() && !seen->damaged_at)
    return fail(ErrorKind::unsuitable, *player.refused(), reader->path(), "was it made by a newer version?");
  ReplayOutcome outcome = player.outcome();
  if (outcome.ticks == 0 && !outcome.lost_at)
    return tl::unexpected(no_ticks_in(reader->path(), seen->damaged_at));
  outcome.lost = seen->lost;
  outcome.ending = seen->ending;
  outcome.damaged_at = seen->damaged_at;
  if (!player.is_over() && outcome.lost > 0) outcome.lost_at = outcome.ticks;  // after the last one
  if (at_end && outcome.same()) at_end(player.scene());
  return outcome;
}

}  // namespace tacto::playback

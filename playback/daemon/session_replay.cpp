// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/session_replay.hpp"

#include <fmt/format.h>

#include <bit>
#include <deque>
#include <memory>
#include <utility>

#include "firmware-host/wire_words.hpp"
#include "playback/daemon/session_board.hpp"
#include "playback/daemon/session_rows.hpp"
#include "playback/daemon/upload_watch.hpp"

namespace tacto::playback {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;
using schema::SessionCommand;
using schema::SessionTick;

constexpr std::uint64_t kBeatEvery = 8;  // ticks; a watchdog of 10 ms at 1 kHz is 10
constexpr std::uint64_t kNever = UINT64_MAX;

wire::MessageType type_of(const SessionCommand& command) {
  return static_cast<wire::MessageType>(command.frame[3]);
}

// The first tick in fault: before it the host has to be as silent as it was.
struct FirstFault {
  std::uint64_t tick = kNever;
  std::uint64_t watchdog_ticks = 0;

  void see(const std::vector<SessionTick>& ticks) {
    for (const SessionTick& row : ticks)
      if (tick == kNever && (row.flags & wire::kTickFault) != 0) tick = row.tick;
  }
  // Whatever the cause was: a silence that ends in the same tick changes nothing about another cause.
  bool beats_before(std::uint64_t now) const {
    const std::uint64_t last = tick - std::min(tick, watchdog_ticks + 1);
    if (tick != kNever && tick > watchdog_ticks && now == last) return true;
    return now % kBeatEvery == 0 && (tick == kNever || now < last || now > tick);
  }
};

// From protocol 1.2 on, ticks say whether the finger touches. Older sessions do not name the protocol.
bool tells_touch(const schema::SessionHeader& header) {
  const std::string& protocol = header.device_protocol;
  return !protocol.empty() && protocol != "1.0" && protocol != "1.1";
}

// What has to be known of the whole before its first tick.
struct Overview {
  FirstFault fault;
  bool gated = false;  // by contact
  std::uint64_t lost = 0;
  schema::SessionEnding ending = schema::SessionEnding::unread;
  std::optional<std::uint64_t> damaged_at;
  UploadWatch upload;
  bool ticks = false;  // it holds some
};

Result<Overview> overview_of(const std::string& name) {
  auto reader = schema::SessionReader::open(name);
  if (!reader) return schema::forward_error(reader);
  Overview seen;
  FirstFault& fault = seen.fault;
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block)) {
      seen.ticks = true;
      fault.see(*ticks);
    }
    if (const auto* loss = std::get_if<schema::SessionLoss>(&*block)) seen.lost += loss->count;
    if (const auto* end = std::get_if<schema::SessionEnd>(&*block)) seen.lost = end->lost_ticks;
    const auto* command = std::get_if<SessionCommand>(&*block);
    if (command == nullptr) continue;
    seen.upload.see(*command);
    if (!is_frame(command->frame))
      return fail(Fault::malformed, "a command in it is no frame of the wire", reader->path());
    if (const auto limits = message_in_frame<wire::Limits>(command->frame))
      fault.watchdog_ticks = static_cast<std::uint32_t>(1e-6F * limits->watchdog_ms *
                                                        static_cast<float>(1e3 * reader->header().rate_hz));
    if (const auto contact = message_in_frame<wire::Contact>(command->frame)) seen.gated = contact->on_n > 0;
  }
  seen.ending = reader->ending();
  if (seen.ending == schema::SessionEnding::damaged) seen.damaged_at = reader->sound_bytes();
  return seen;
}

class SessionPlayer {
 public:
  SessionPlayer(const schema::SessionHeader& header, const FirstFault& fault, const WishListener& wishes)
      : board_(header), fault_(fault), wishes_(wishes) {
    if (wishes_) unlimited_ = std::make_unique<SessionBoard>(header, BoardLimits::lifted);
  }

  // Upload goes in at once; arming waits for the first tick, steering for the tick that took it. What is
  // uploaded after arming goes in right before the change that is to it: then the device is known to have
  // taken it. What no change is to did nothing.
  void hand(const SessionCommand& command) {
    const wire::MessageType type = type_of(command);
    if (type == wire::MessageType::arm) {
      arming_ = command;
      return;
    }
    if (!arming_) return obey(command);
    if (type == wire::MessageType::profile_begin) next_.clear();
    if (!wire::steers(type)) return next_.push_back(command);
    waiting_.push_back({{}, command});
    if (type == wire::MessageType::change) waiting_.back().upload = std::exchange(next_, {});
  }
  void play(const std::vector<SessionTick>& ticks) {
    for (const SessionTick& tick : ticks) {
      if (is_over()) return;
      take(tick);
    }
  }

  bool is_over() const { return refused_.has_value() || outcome_.first_difference || outcome_.lost_at; }
  const std::optional<std::string>& refused() const { return refused_; }
  const ReplayOutcome& outcome() const { return outcome_; }

 private:
  struct Steering {
    std::vector<SessionCommand> upload;  // that belongs to it
    SessionCommand command;
  };
  void obey(const SessionCommand& command) {
    if (refused_) return;
    const auto answer = board_.say_frame(command.frame);
    if (unlimited_) unlimited_->say_frame(command.frame);
    if (answer && answer->code == wire::AnswerCode::ok) return;
    const auto words = answer ? firmware_host::words_of(answer->code, answer->detail).what : "no answer";
    refused_ = fmt::format("{} is refused: {}", firmware_host::word_of(type_of(command)), words);
  }
  void obey_next() {
    const Steering next = std::move(waiting_.front());
    waiting_.pop_front();
    for (const SessionCommand& part : next.upload) obey(part);
    obey(next.command);
  }
  void take(const SessionTick& tick) {
    if (tick.tick != outcome_.ticks) {
      outcome_.lost_at = outcome_.ticks;
      return;
    }
    if (tick.tick == 0 && arming_) {
      board_.rest_at(tick.encoder);
      if (unlimited_) unlimited_->rest_at(tick.encoder);
      obey(*arming_);
    }
    const auto steered = static_cast<std::uint8_t>(tick.flags >> wire::kTickSteeredShift);
    for (; steered_ != steered && !waiting_.empty(); ++steered_) obey_next();
    const bool beats = fault_.beats_before(tick.tick);
    if (beats) board_.say(wire::Heartbeat{});
    compare(tick, board_.tick(tick));
    if (unlimited_) tell_wish(tick, beats);
  }
  void tell_wish(const SessionTick& tick, bool beats) {
    if (beats) unlimited_->say(wire::Heartbeat{});
    const float wished_v = unlimited_->tick(tick);
    if (!outcome_.first_difference) wishes_(tick, wished_v);
  }
  void compare(const SessionTick& tick, float replayed_v) {
    ++outcome_.ticks;
    if (std::bit_cast<std::uint32_t>(replayed_v) == std::bit_cast<std::uint32_t>(tick.drive_v)) return;
    outcome_.first_difference = {tick.tick, tick.drive_v, replayed_v};
  }

  SessionBoard board_;
  std::unique_ptr<SessionBoard> unlimited_;  // where somebody asks for its drive
  FirstFault fault_;
  const WishListener& wishes_;
  std::optional<SessionCommand> arming_;
  std::deque<Steering> waiting_;
  std::vector<SessionCommand> next_;  // what was uploaded since, for a change to come
  std::optional<std::string> refused_;
  ReplayOutcome outcome_;
  std::uint8_t steered_ = 0;
};

// Commands stand in the file where they were sent; a tick that took one may stand before it by what was on
// its way. They are few: all are read first.
Result<void> hand_over_commands(const std::string& name, SessionPlayer& player) {
  auto reader = schema::SessionReader::open(name);
  if (!reader) return schema::forward_error(reader);
  while (const auto block = reader->next())
    if (const auto* command = std::get_if<SessionCommand>(&*block)) player.hand(*command);
  return {};
}

// A damaged file may lack what stood behind the damage.
Result<void> check_replayable(const Overview& seen, const schema::SessionReader& reader) {
  const std::string missing = seen.upload.missing();
  if (!missing.empty() && seen.ticks && !seen.damaged_at)
    return fail(Fault::unsuitable,
                fmt::format("lacks {}: the disk did not take it (was it full?), and without it the drive "
                            "can't be computed again",
                            missing),
                reader.path(), "the ticks that are in it can be exported: tactograph session");
  if (!seen.gated || tells_touch(reader.header())) return {};
  return fail(Fault::unsuitable,
              "was gated by contact, and its ticks do not say when the finger touched: its drive can't be "
              "computed again",
              reader.path(), "play anew, on firmware of protocol 1.2 or newer");
}

}  // namespace

Result<ReplayOutcome> replay_session(const std::string& name, const std::function<void(double)>& progress,
                                     const WishListener& wishes) {
  const auto seen = overview_of(name);
  if (!seen) return schema::forward_error(seen);
  auto reader = schema::SessionReader::open(name);
  if (!reader) return schema::forward_error(reader);
  if (const auto may = check_replayable(*seen, *reader); !may) return schema::forward_error(may);
  SessionPlayer player(reader->header(), seen->fault, wishes);
  if (const auto handed = hand_over_commands(name, player); !handed) return schema::forward_error(handed);
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block)) player.play(*ticks);
    if (player.is_over()) break;
    if (progress) progress(part_read(*reader));
  }
  if (player.refused() && !seen->damaged_at)
    return fail(Fault::unsuitable, *player.refused(), reader->path(), "was it made by a newer version?");
  ReplayOutcome outcome = player.outcome();
  if (outcome.ticks == 0 && !outcome.lost_at)
    return tl::unexpected(no_ticks_in(reader->path(), seen->damaged_at));
  outcome.lost = seen->lost;
  outcome.ending = seen->ending;
  outcome.damaged_at = seen->damaged_at;
  if (!player.is_over() && outcome.lost > 0) outcome.lost_at = outcome.ticks;  // after the last one
  return outcome;
}

}  // namespace tacto::playback

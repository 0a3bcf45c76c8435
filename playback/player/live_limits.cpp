// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/live_limits.hpp"

#include <fmt/format.h>

#include <utility>

#include "firmware-host/link/wire_words.hpp"
#include "playback/session/session_limits.hpp"

namespace tacto::playback {
namespace {

using schema::SessionCommand;
using schema::SessionTick;

std::optional<double> db_of(const LimitTally& tally) {
  return tally.removed_any() ? std::optional(tally.removed_db()) : std::nullopt;
}

}  // namespace

LiveLimits::LiveLimits(const schema::SessionHeader& header, std::size_t profile_samples)
    : rate_hz_(header.rate_hz),
      board_(std::make_unique<SessionBoard>(header, BoardLimits::lifted, profile_samples)) {}

void LiveLimits::give_up(std::string why) {
  board_.reset();
  waiting_.clear();
  const std::lock_guard lock(mutex_);
  reported_ = {{}, {}, std::move(why)};
}

void LiveLimits::add_command(const SessionCommand& command) {
  if (!board_) return;
  beats_.see(command, rate_hz_);
  commands_.hand(command, [this](const SessionCommand& due) { obey(due); });
}

void LiveLimits::obey(const SessionCommand& command) {
  if (!board_) return;
  const auto answer = board_->send_frame(command.frame);
  if (answer && answer->code == wire::AnswerCode::ok) return;
  give_up(fmt::format("{} is refused by the computed kernel", firmware_host::to_string(type_of(command))));
}

void LiveLimits::take(std::span<const SessionTick> ticks) {
  for (const SessionTick& tick : ticks) {
    if (!board_) return;
    if (tick.tick != expected_++) return give_up("ticks are missing");
    beats_.see(tick);
    waiting_.push_back(tick);
  }
  follow(beats_.looks_ahead());
  publish();
}

void LiveLimits::lose(const std::string& what) {
  if (board_) give_up(what + " are missing");
}

void LiveLimits::follow(std::uint64_t held_back) {
  while (board_ && waiting_.size() > held_back) {
    const SessionTick tick = waiting_.front();
    waiting_.pop_front();
    play(tick);
  }
}

void LiveLimits::play(const SessionTick& tick) {
  if (tick.tick == 0) board_->rest_at(tick);
  commands_.before(tick, [this](const SessionCommand& due) { obey(due); });
  if (!board_) return;
  if (beats_.beats_before(tick.tick)) board_->say(wire::Heartbeat{});
  const float unlimited_v = board_->tick(tick);
  limited_ = limited_ || (tick.flags & kEveryLimit) != 0;
  if (!limited_ && unlimited_v != tick.drive_v) return give_up("the device computes a different drive");
  count(tick, unlimited_v);
}

void LiveLimits::count(const SessionTick& tick, float unlimited_v) {
  const auto part = static_cast<std::uint64_t>(static_cast<double>(tick.tick) * kParts / rate_hz_);
  if (part != std::exchange(part_, part)) parts_[part % kParts] = {};
  const core::TickOutput output = limited_tick(tick.drive_v, unlimited_v, tick.flags);
  whole_.add(output);
  parts_[part % kParts].add(output);
}

void LiveLimits::end() {
  follow(0);
  publish();
  board_.reset();
}

void LiveLimits::publish() {
  if (!board_) return;
  LimitTally second;
  for (const LimitTally& part : parts_) second.add(part);
  const std::lock_guard lock(mutex_);
  reported_ = {db_of(whole_), db_of(second), {}};
}

LimitsTook LiveLimits::figures() const {
  const std::lock_guard lock(mutex_);
  return reported_;
}

}  // namespace tacto::playback

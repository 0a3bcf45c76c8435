// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/session_commands.hpp"

#include <algorithm>
#include <utility>

#include "firmware-host/core/wire/message_types.hpp"
#include "playback/session/session_board.hpp"

namespace tacto::playback {
namespace {

using schema::SessionCommand;
using schema::SessionTick;

constexpr std::uint64_t kBeatEvery = 8;  // ticks; a watchdog of 10 ms at 1 kHz is 10

}  // namespace

void SessionCommands::hand(const SessionCommand& command, const Obey& obey) {
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

void SessionCommands::before(const SessionTick& tick, const Obey& obey) {
  if (tick.tick == 0 && arming_) obey(*arming_);
  const auto steered = static_cast<std::uint8_t>(tick.flags >> wire::kTickSteeredShift);
  for (; steered_ != steered && !waiting_.empty(); ++steered_) {
    const Steering next = std::move(waiting_.front());
    waiting_.pop_front();
    for (const SessionCommand& part : next.upload) obey(part);
    obey(next.command);
  }
}

void HostBeats::see(const SessionCommand& command, double rate_hz) {
  std::optional<std::uint16_t> watchdog_ms;
  if (const auto limits = message_in_frame<wire::Limits>(command.frame)) watchdog_ms = limits->watchdog_ms;
  if (const auto limits = message_in_frame<wire::ForceLimits>(command.frame))
    watchdog_ms = limits->watchdog_ms;
  if (watchdog_ms)
    watchdog_ticks_ = static_cast<std::uint32_t>(1e-6F * *watchdog_ms * static_cast<float>(1e3 * rate_hz));
}

void HostBeats::see(const SessionTick& tick) {
  if (fault_ == kNever && (tick.flags & wire::kTickFault) != 0) fault_ = tick.tick;
}

bool HostBeats::beats_before(std::uint64_t tick) const {
  const std::uint64_t last = fault_ - std::min(fault_, watchdog_ticks_ + 1);
  if (fault_ != kNever && fault_ > watchdog_ticks_ && tick == last) return true;
  return tick % kBeatEvery == 0 && (fault_ == kNever || tick < last || tick > fault_);
}

}  // namespace tacto::playback

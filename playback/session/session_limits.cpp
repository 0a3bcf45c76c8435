// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/session_limits.hpp"

#include <fmt/format.h>

#include "playback/session/session_replay.hpp"
#include "playback/session/session_rows.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using schema::SessionTick;

struct FlagsSeen {
  bool limited = false, whole = true;

  void take(const std::vector<SessionTick>& ticks) {
    for (const SessionTick& tick : ticks) limited = limited || (tick.flags & kEveryLimit) != 0;
    whole = whole && (ticks.empty() || ticks.front().tick == next);
    if (!ticks.empty()) next = ticks.back().tick + 1;
  }
  std::uint64_t next = 0;
};

Result<FlagsSeen> flags_in(const std::string& session) {
  auto reader = schema::SessionReader::open(session);
  TACTO_TRY(reader);
  FlagsSeen seen;
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block)) seen.take(*ticks);
    if (const auto* end = std::get_if<schema::SessionEnd>(&*block))
      seen.whole = seen.whole && end->lost_ticks == 0;
  }
  seen.whole = seen.whole && reader->ending() != schema::SessionEnding::damaged;
  return seen;
}

using TickListener = std::function<void(const SessionTick& tick)>;

Result<void> hear_ticks(const std::string& session, std::uint64_t from, const TickListener& listener,
                        const std::function<void(double)>& progress) {
  auto reader = schema::SessionReader::open(session);
  TACTO_TRY(reader);
  std::uint64_t heard = 0;
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block))
      for (const SessionTick& tick : *ticks)
        if (heard++ >= from) listener(tick);
    if (progress) progress(part_read(*reader));
  }
  return {};
}

tl::unexpected<schema::Error> not_known(const std::string& why, const std::string& session) {
  return fail(ErrorKind::unsuitable, "the effect of the limits is not known: " + why,
              schema::session_path(session), "`tactograph replay` gives details");
}

}  // namespace

core::TickOutput limited_tick(float drive_v, float unlimited_v, std::uint32_t flags) {
  core::TickOutput output;
  output.drive_v = drive_v;
  output.unlimited_v = unlimited_v;
  output.flags = flags;
  return output;
}

Result<void> read_unlimited(const std::string& session, const UnlimitedListener& listener,
                            const std::function<void(double)>& progress) {
  const auto seen = flags_in(session);
  TACTO_TRY(seen);
  if (!seen->whole) return not_known("ticks are missing", session);
  if (!seen->limited)
    return hear_ticks(
        session, 0, [&](const SessionTick& tick) { listener(tick, tick.drive_v); }, progress);
  const auto outcome = replay_session(session, progress, listener);
  TACTO_TRY(outcome);
  if (!outcome->first_difference) return {};
  return not_known(fmt::format("the replayed drive differs from tick {} on", outcome->first_difference->tick),
                   session);
}

Result<std::optional<schema::Error>> read_unlimited_where_known(
    const std::string& session,
    const std::function<void(const SessionTick& tick, std::optional<float> unlimited_v)>& listener,
    const std::function<void(double)>& progress) {
  std::uint64_t heard = 0;
  const auto read = read_unlimited(
      session, [&](const SessionTick& tick, float unlimited_v) { ++heard, listener(tick, unlimited_v); },
      progress);
  if (read) return std::optional<schema::Error>();
  const auto rest = hear_ticks(
      session, heard, [&](const SessionTick& tick) { listener(tick, std::nullopt); }, progress);
  TACTO_TRY(rest);
  return std::optional(read.error());
}

Result<LimitTally> tally_session(const std::string& session) {
  LimitTally tally;
  const auto heard = read_unlimited(session, [&](const SessionTick& tick, float unlimited_v) {
    tally.add(limited_tick(tick.drive_v, unlimited_v, tick.flags));
  });
  return heard ? Result<LimitTally>(tally) : schema::forward_error(heard);
}

}  // namespace tacto::playback

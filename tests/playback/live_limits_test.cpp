// SPDX-License-Identifier: GPL-3.0-or-later
// The effect of the limits as reported during playback, against the session's report afterwards.
#include "playback/player/live_limits.hpp"

#include "playback/session/session_limits.hpp"
#include "tests/playback/full_disk.hpp"
#include "tests/playback/limited_play.hpp"

namespace tacto::playback {
namespace {

constexpr std::uint64_t kWatchdogTicks = 200;  // 100 ms, the default

class LiveLimitsTest : public LimitedPlay {
 protected:
  LiveLimitsTest() { tell_limits_ = true; }

  LimitTally tally() {
    const auto tally = tally_session(session_);
    EXPECT_TRUE(tally) << schema::message(tally.error());
    return tally.value_or(LimitTally());
  }
  // The same core adds in the same order, so that there is no rounding difference.
  void expect_as_the_session_tells() {
    const LimitsTook live = player_->status().limits;
    EXPECT_EQ(live.unknown, "");
    ASSERT_TRUE(live.db);
    EXPECT_EQ(*live.db, tally().removed_db());
  }
  // Follows a session, a few ticks at a time, with `change` applied to the ticks of a block; calls `hear`
  // after each block.
  LimitsTook follow_session(const std::function<void(std::vector<schema::SessionTick>&)>& change = {},
                            const std::function<void(const LiveLimits&, std::uint64_t ticks)>& hear = {}) {
    auto reader = schema::SessionReader::open(session_);
    LiveLimits live(reader->header(), 1 << 20);
    std::uint64_t taken = 0;
    while (auto block = reader->next()) {
      if (const auto* command = std::get_if<schema::SessionCommand>(&*block)) live.add_command(*command);
      auto* ticks = std::get_if<std::vector<schema::SessionTick>>(&*block);
      if (ticks == nullptr) continue;
      if (change) change(*ticks);
      for (std::span<const schema::SessionTick> left(*ticks); !left.empty();) {
        const std::size_t few = std::min<std::size_t>(left.size(), 7);
        live.take(left.first(few));
        left = left.subspan(few);
      }
      taken += ticks->size();
      if (hear) hear(live, taken);
    }
    live.end();
    return live.figures();
  }
  // The value for ticks from..to-1 of the session.
  std::optional<double> part_db(std::uint64_t from, std::uint64_t to) {
    LimitTally part;
    EXPECT_TRUE(read_unlimited(session_, [&](const schema::SessionTick& tick, float unlimited_v) {
      if (tick.tick >= from && tick.tick < to) part.add(limited_tick(tick.drive_v, unlimited_v, tick.flags));
    }));
    return part.removed_any() ? std::optional(part.removed_db()) : std::nullopt;
  }
};

TEST_F(LiveLimitsTest, IsWhatTheSessionTells) {
  bender_.drive_limit_v = 0.2;
  drive_of(bender_, {}, "weak");
  expect_as_the_session_tells();
  EXPECT_GT(tally().removed_db(), -20) << "the test takes nothing away";
}

TEST_F(LiveLimitsTest, IsWhatTheSessionTellsOfSlew) {
  bender_.slew_limit_v_per_s = 60;
  bender_.drive_limit_v = 0.4;  // so that a release takes at most 18 ms
  drive_of(bender_, {}, "slow");
  expect_as_the_session_tells();
}

TEST_F(LiveLimitsTest, IsWhatTheSessionTellsOfEnergy) {
  schema::PlaybackChoices choices;
  choices.energy_rms_v = 0.15;
  choices.energy_window_s = 0.1;
  drive_of(bender_, choices, "cool");
  expect_as_the_session_tells();
}

TEST_F(LiveLimitsTest, IsNoneWhereNothingIsTaken) {
  drive_of(bender_, {}, "free");
  const LimitsTook live = player_->status().limits;
  EXPECT_FALSE(tally().removed_any());
  EXPECT_FALSE(live.db);
  EXPECT_FALSE(live.last_second_db);
  EXPECT_EQ(live.unknown, "");
}

TEST_F(LiveLimitsTest, IsNotToldUnlessAsked) {
  tell_limits_ = false;
  bender_.drive_limit_v = 0.2;
  drive_of(bender_, {}, "weak");
  EXPECT_FALSE(player_->status().limits.db);
}

// During playback: for all ticks except the newest ones within the delay, and for the newest second of them.
TEST_F(LiveLimitsTest, FollowsTheTicksByTheWatchdog) {
  bender_.drive_limit_v = 0.2;
  drive_of(bender_, {}, "weak");
  std::size_t compared = 0;
  follow_session({}, [&](const LiveLimits& live, std::uint64_t ticks) {
    if (ticks < 2400 || compared++ % 8 != 0) return;  // each comparison replays the session
    const std::uint64_t known = ticks - kWatchdogTicks - 1;
    const auto tenth = static_cast<std::uint64_t>(kRateHz / 10);
    const LimitsTook told = live.figures();
    EXPECT_EQ(told.db, part_db(0, known));
    const auto second = part_db((known - 1) / tenth * tenth - 9 * tenth, known);
    ASSERT_EQ(told.last_second_db.has_value(), second.has_value());
    if (second) {
      EXPECT_NEAR(*told.last_second_db, *second, kRoundingsDb);
    }
  });
  EXPECT_GT(compared, 0U);
}

TEST_F(LiveLimitsTest, TheLastSecondForgets) {
  bender_.drive_limit_v = 0.2;
  drive_of(bender_, {}, "weak");
  ASSERT_TRUE(player_->status().limits.last_second_db);
  ASSERT_TRUE(player_->arm(folder_ / "next.session"));
  ASSERT_TRUE(player_->play());
  run(0.5);
  ASSERT_TRUE(player_->stop());
  run(1.3);
  ASSERT_TRUE(player_->disarm());
  EXPECT_TRUE(player_->status().limits.db);
  EXPECT_FALSE(player_->status().limits.last_second_db) << "the drive was at zero";
}

// After a fault the drive ramps down; the ticks after it are part of the session, too.
TEST_F(LiveLimitsTest, AJumpIsFollowedIntoItsFault) {
  bender_.drive_limit_v = 0.2;
  jump_s_ = 0.7;
  begin_play(bender_, {}, "jumps");
  run(1);
  ASSERT_EQ(player_->state(), PlayerState::fault);
  ASSERT_TRUE(player_->disarm());
  expect_as_the_session_tells();
}

TEST_F(LiveLimitsTest, ASilentHostIsFollowedIntoItsFault) {
  bender_.drive_limit_v = 0.2;
  begin_play(bender_, {}, "silent");
  run(0.5);
  for (double t = 0; t < 0.15; t += 1 / kRateHz) device_->board().step(), device_->board().poll();
  run(0.1);
  ASSERT_EQ(player_->state(), PlayerState::fault);
  ASSERT_TRUE(player_->disarm());
  expect_as_the_session_tells();
  EXPECT_EQ(follow_session().db, tally().removed_db()) << "the fault is not seen together with the silence";
}

// The recorder's thread writes every 20 ms of real time; the test waits for it.
TEST_F(LiveLimitsTest, IsNotKnownFromTicksOnThatTheDiskDidNotTake) {
  bender_.drive_limit_v = 0.2;
  begin_play(bender_, {}, "full");
  const std::uint64_t played_from = ticks_here();
  while (player_->recorded()->ticks <= played_from) ASSERT_TRUE(player_->step(0.01));
  ASSERT_EQ(player_->status().limits.unknown, "");
  {
    const FullDisk full(1);
    while (player_->recorded()->disk_lost == 0) ASSERT_TRUE(player_->step(0.01));
  }
  EXPECT_EQ(player_->status().limits.unknown, "ticks are missing");
  run(0.3);
  ASSERT_TRUE(player_->disarm());
  EXPECT_FALSE(player_->status().limits.db);
  const auto told = tally_session(session_);
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().kind, schema::ErrorKind::unsuitable);
}

TEST_F(LiveLimitsTest, SaysWhyItIsNotKnown) {
  bender_.drive_limit_v = 0.2;
  drive_of(bender_, {}, "weak");
  const auto all = follow_session();
  EXPECT_TRUE(all.db);
  const auto holed = follow_session([](std::vector<schema::SessionTick>& ticks) {
    if (ticks.front().tick > 0) ticks.erase(ticks.begin());
  });
  EXPECT_EQ(holed.unknown, "ticks are missing");
  EXPECT_FALSE(holed.db);
  const auto other =
      follow_session([](std::vector<schema::SessionTick>& ticks) { ticks[1].drive_v += 1e-6F; });
  EXPECT_FALSE(other.db);
  EXPECT_FALSE(other.unknown.empty());
  EXPECT_NE(other.unknown, holed.unknown);
}

}  // namespace
}  // namespace tacto::playback

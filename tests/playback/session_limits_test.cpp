// SPDX-License-Identifier: GPL-3.0-or-later
// The effect of a session's limits, against a playback without limits.
#include "playback/session/session_limits.hpp"

#include "playback/strokes/stroke_report.hpp"
#include "tests/playback/limited_play.hpp"

namespace tacto::playback {
namespace {

using SessionLimits = LimitedPlay;

TEST_F(SessionLimits, NothingIsTakenWhereNoneIsReached) {
  drive_of(bender_, {}, "free");
  const auto tally = tally_session(session_);
  ASSERT_TRUE(tally) << schema::message(tally.error());
  EXPECT_FALSE(tally->removed_any());
  EXPECT_EQ(tally->ticks(), ticks().size());
}

TEST_F(SessionLimits, AmplitudeIsToldInDb) {
  const auto unlimited = drive_of(bender_, {}, "free");
  bender_.drive_limit_v = 0.2;
  const auto drive = drive_of(bender_, {}, "weak");
  ASSERT_EQ(unlimited.size(), drive.size());
  const auto tally = tally_session(session_);
  ASSERT_TRUE(tally) << schema::message(tally.error());
  const double expected_db = removed_db(unlimited, drive);
  EXPECT_GT(expected_db, -20) << "the test takes nothing away";
  EXPECT_NEAR(tally->removed_db(), expected_db, kRoundingsDb);
  EXPECT_GT(tally->amplitude_limited(), 100U);
  EXPECT_EQ(tally->energy_limited(), 0U);
}

TEST_F(SessionLimits, SlewIsToldInDb) {
  const auto unlimited = drive_of(bender_, {}, "free");
  bender_.slew_limit_v_per_s = 60;
  bender_.drive_limit_v = 0.4;  // so that a release takes at most 18 ms
  const auto drive = drive_of(bender_, {}, "slow");
  ASSERT_EQ(unlimited.size(), drive.size());
  const auto tally = tally_session(session_);
  ASSERT_TRUE(tally) << schema::message(tally.error());
  EXPECT_NEAR(tally->removed_db(), removed_db(unlimited, drive), kRoundingsDb);
  EXPECT_GT(tally->slew_limited(), 100U);
}

TEST_F(SessionLimits, EnergyIsToldInDb) {
  const auto unlimited = drive_of(bender_, {}, "free");
  schema::PlaybackChoices choices;
  choices.energy_rms_v = 0.15;
  choices.energy_window_s = 0.1;
  const auto drive = drive_of(bender_, choices, "cool");
  ASSERT_EQ(unlimited.size(), drive.size());
  const auto tally = tally_session(session_);
  ASSERT_TRUE(tally) << schema::message(tally.error());
  EXPECT_NEAR(tally->removed_db(), removed_db(unlimited, drive), kRoundingsDb);
  EXPECT_GT(tally->energy_limited(), 100U);
  EXPECT_EQ(tally->amplitude_limited(), 0U);
}

// A stroke's share is that of its own ticks.
TEST_F(SessionLimits, EachStrokeIsToldItsOwn) {
  const auto unlimited = drive_of(bender_, {}, "free");
  bender_.drive_limit_v = 0.2;
  const auto drive = drive_of(bender_, {}, "weak");
  const auto report = report_strokes(session_);
  ASSERT_TRUE(report) << schema::message(report.error());
  ASSERT_GT(report->strokes.size(), 1U);
  for (const PlayedStroke& stroke : report->strokes) {
    const auto part = [&](const std::vector<double>& all) {
      return std::vector<double>(all.begin() + std::lround(stroke.from_s * kRateHz),
                                 all.begin() + std::lround(stroke.to_s * kRateHz) + 1);
    };
    ASSERT_TRUE(stroke.limits);
    EXPECT_EQ(stroke.limits->ticks(), part(drive).size());
    EXPECT_NEAR(stroke.limits->removed_db(), removed_db(part(unlimited), part(drive)), kRoundingsDb);
  }
}

}  // namespace
}  // namespace tacto::playback

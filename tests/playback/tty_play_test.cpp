// SPDX-License-Identifier: GPL-3.0-or-later
// A texture played on an emulated board behind a serial port; its session replays to the bit.
#include <gtest/gtest.h>

#include <cstdio>

#include "playback/player/play.hpp"
#include "playback/session/session_replay.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/firmware-host/pty_board.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

constexpr double kOnPortS = 1;

PlayOptions played_on(const std::string& uri, const tests::TemporaryFolder& folder) {
  PlayOptions options;
  options.program = {folder / "grating", {}, {}, schema::Gain{5e-4, false}};
  options.device_uri = uri;
  options.time_s = kOnPortS;
  options.prepare.rate_hz = kRateHz;
  options.prepare.watchdog_ms = 1000;  // the longest
  options.session = folder / "one.session";
  return options;
}

const auto kNeverStopped = [] { return false; };

// The board keeps time: if this machine stops for longer than the longest watchdog, playing ends in a fault,
// as it should. That session has to replay, too.
TEST(TtyPlay, ReplaysToTheBit) {
  for (int attempt = 1; attempt <= 5; ++attempt) {
    const tests::TemporaryFolder folder;
    ASSERT_TRUE(schema::write_texture(folder / "grating", grating()));
    const tests::PtyBoard board(folder / "port", "sim:surface=C,speed=50mm/s,seed=1,rate=2kHz");
    const auto outcome = play_once(played_on(board.uri(), folder), kNeverStopped);
    ASSERT_TRUE(outcome) << schema::message(outcome.error());
    EXPECT_EQ(outcome->recorder.lost(), 0U);
    const auto replayed = replay_session(folder / "one.session");
    ASSERT_TRUE(replayed) << schema::message(replayed.error());
    EXPECT_TRUE(replayed->same());
    EXPECT_EQ(replayed->ticks, outcome->recorder.ticks);
    if (outcome->status.state == PlayerState::fault) continue;
    EXPECT_GT(outcome->status.ticks.drive_peak_v(), 0.01) << "the finger moved over the texture";
    EXPECT_GE(outcome->recorder.ticks, static_cast<std::uint64_t>(kOnPortS * kRateHz));
    return;
  }
  std::puts("not judged: in five attempts this machine stopped for longer than the watchdog's time");
}

// 2000 ticks per second need 27,600 bytes/s; 57,600 baud carry 5760.
TEST(TtyPlay, ARateThatTheLineDoesNotCarryIsRefused) {
  const tests::TemporaryFolder folder;
  ASSERT_TRUE(schema::write_texture(folder / "grating", grating()));
  const tests::PtyBoard board(folder / "port", "sim:rate=2kHz");
  const auto outcome = play_once(played_on(board.uri() + ",baud=57600", folder), kNeverStopped);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_FALSE(std::filesystem::exists(folder / "one.session"));
}

}  // namespace
}  // namespace tacto::playback

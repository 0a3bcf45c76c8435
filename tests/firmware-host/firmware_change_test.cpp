// SPDX-License-Identifier: GPL-3.0-or-later
// Changes the texture during playback: the place of the next one in memory, the permitted times, the drive.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/firmware-host/firmware_bench.hpp"

namespace tacto::core {
namespace {

using tests::FirmwareBench;
using tests::kTenKilohertz;
using tests::kTestLimits;
using wire::AnswerCode;
using wire::DriveState;

constexpr std::uint32_t kRoom = 4096;  // samples in the test board's memory
// 500 steps of the weight, each rounded to 2^-25, times the largest slope, 1.5, times 5 V between the
// textures.
constexpr double kBlendErrorV = 500 * 0x1p-25 * 1.5 * 5;

std::vector<float> sine(std::size_t samples, double amplitude) {
  std::vector<float> values(samples);
  for (std::size_t i = 0; i < samples; ++i)
    values[i] = static_cast<float>(
        amplitude * std::sin(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(samples)));
  return values;
}

/// The weight of the old texture, `tick` ticks after the tick that started the change.
double leaving(int tick, int fade_ticks) {
  const double u = std::max(0.0, 1 - static_cast<double>(tick) / fade_ticks);
  return u * u * (3 - 2 * u);
}

void move_on(FirmwareBench& bench, int counts_per_tick, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    bench.board.encoder += counts_per_tick;
    bench.run(1, i % 100 == 0);
  }
}

// One count per tick, and no interpolation between counts: the target is the texture's samples.
TEST(FirmwareChange, TheDriveIsTheBlendOfBothTextures) {
  const auto one = sine(64, 2), two = sine(48, -3);
  FirmwareBench bench;
  bench.expect_ok(bench.code(kTestLimits));
  bench.upload(one);
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
  bench.expect_ok(bench.code(wire::Play{}));
  move_on(bench, 1, 60);
  bench.upload(two);
  move_on(bench, 1, 40);
  bench.expect_ok(bench.code(wire::Change{0.05F}));
  float before_v = bench.board.drive_v;
  for (int i = 0; i < 700; ++i) {
    move_on(bench, 1, 1);
    const auto at = static_cast<std::size_t>(bench.board.encoder);
    const double old = leaving(i, 500);
    ASSERT_NEAR(bench.board.drive_v, old * one[at % 64] + (1 - old) * two[at % 48], kBlendErrorV) << i;
    // The steepest of the two sines, 3 V x 2 pi / 48, and the fade between them, 5 V x 1.5 / 500.
    ASSERT_LT(std::abs(bench.board.drive_v - before_v), 0.393 + 0.015) << i;
    before_v = bench.board.drive_v;
  }
  EXPECT_EQ(bench.board.drive_v, two[static_cast<std::size_t>(bench.board.encoder) % 48]);
}

TEST(FirmwareChange, TheFirstTickOfItCountsIt) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(-1);
  bench.expect_ok(bench.code(wire::Change{0}));
  bench.run(100);
  const auto counted = std::ranges::find_if(
      bench.ticks, [](const wire::Tick& tick) { return tick.flags >> wire::kTickSteeredShift == 2; });
  ASSERT_LT(counted + 2, bench.ticks.end());
  EXPECT_EQ(counted[-1].drive_v, 1);
  EXPECT_EQ(counted[0].drive_v, 1) << "the old one is still whole";
  EXPECT_LT(counted[1].drive_v, 0) << "no fade was asked for: the slew limit alone is between them";
  EXPECT_EQ(bench.board.drive_v, -1);
}

TEST(FirmwareChange, GainIsLiveThroughout) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  bench.expect_ok(bench.code(wire::Gain{0.5F}));
  bench.expect_ok(bench.code(wire::Change{0.02F}));
  bench.run(100);
  bench.expect_ok(bench.code(wire::Gain{-1}));
  bench.run(250);
  EXPECT_EQ(bench.board.drive_v, -2);
}

// The next texture is placed at the end of the memory, then at the start, and so on, so that the free memory
// is one piece.
TEST(FirmwareChange, TheNextOneLiesBesideTheOneThatPlays) {
  FirmwareBench bench;
  bench.play_profile(1);
  std::uint32_t running = 64;
  for (const std::uint32_t samples : {1000U, 3000U, 70U, 4026U}) {
    EXPECT_EQ(bench.command(FirmwareBench::begin_of(kRoom - running + 1)).detail, kRoom - running);
    const std::vector<float> before(bench.board.profile, bench.board.profile + kRoom);
    const std::vector<float> next(samples, static_cast<float>(samples) * 1e-3F);
    bench.upload(next);
    bench.drives.clear();
    bench.run(20);
    for (const float drive_v : bench.drives)
      ASSERT_EQ(drive_v, bench.drives[0]) << "what plays was written to";
    std::uint32_t touched = 0;
    for (std::uint32_t i = 0; i < kRoom; ++i) touched += bench.board.profile[i] != before[i];
    EXPECT_EQ(touched, samples);
    bench.expect_ok(bench.code(wire::Change{0.001F}));
    bench.run(60);
    EXPECT_EQ(bench.board.drive_v, next[0]);
    running = samples;
  }
  EXPECT_EQ(bench.command(FirmwareBench::begin_of(71)).detail, 70U);
}

TEST(FirmwareChange, AProfileThatFillsTheMemoryLeavesNoRoom) {
  FirmwareBench bench;
  bench.expect_ok(bench.code(kTestLimits));
  bench.upload(std::vector<float>(kRoom, 1));
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
  const wire::Answer answer = bench.command(FirmwareBench::begin_of(6));
  EXPECT_EQ(answer.code, AnswerCode::too_large);
  EXPECT_EQ(answer.detail, 0U);
}

TEST(FirmwareChange, NothingBeginsWhileWhatLeavesIsRead) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  bench.expect_ok(bench.code(wire::Change{0.01F}));
  EXPECT_EQ(bench.code(FirmwareBench::begin_of(64)), AnswerCode::wrong_state) << "no tick has taken it";
  wire::ProfileChunk chunk{};
  chunk.count = 8;
  bench.run(98);
  EXPECT_EQ(bench.code(FirmwareBench::begin_of(64)), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(chunk), AnswerCode::incomplete);
  bench.run(4);
  EXPECT_EQ(bench.code(FirmwareBench::begin_of(64)), AnswerCode::ok);
  EXPECT_EQ(bench.board.drive_v, 2);
}

TEST(FirmwareChange, OnlyAWholeProfileIsChangedTo) {
  FirmwareBench bench;
  bench.play_profile(1);
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::incomplete);
  bench.expect_ok(bench.code(FirmwareBench::begin_of(16)));
  wire::ProfileChunk chunk{};
  chunk.count = 8;
  bench.expect_ok(bench.code(chunk));
  EXPECT_EQ(bench.command(wire::Change{0}).detail, 8U);
  chunk.first = 8;
  bench.expect_ok(bench.code(chunk));
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::incomplete) << "without its check";
  bench.run(50);
  EXPECT_EQ(bench.board.drive_v, 1);
}

TEST(FirmwareChange, AFadeOutOfRangeIsRefused) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  for (const float fade_s : {-0.001F, 10.001F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(bench.code(wire::Change{fade_s}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::Change{10}), AnswerCode::ok);
}

// An answer may be lost; then the command is sent again, and must have no second effect.
TEST(FirmwareChange, SentAgainItDoesNothing) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  for (int i = 0; i < 3; ++i) bench.expect_ok(bench.code(wire::Change{0.001F}));
  bench.run(100);
  bench.expect_ok(bench.code(wire::Change{0.001F}));
  bench.run(100);
  EXPECT_EQ(bench.board.drive_v, 2);
  EXPECT_EQ(bench.ticks.back().flags >> wire::kTickSteeredShift, 2U) << "play, and one change";
  EXPECT_EQ(bench.code(FirmwareBench::begin_of(5000)), AnswerCode::too_large);
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::incomplete)
      << "something else has begun, and came to nothing";
}

TEST(FirmwareChange, WhereNoProfilePlaysThereIsNothingToChange) {
  FirmwareBench bench;
  bench.expect_ok(bench.code(kTestLimits));
  bench.upload_constant(1);
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::wrong_state) << "idle";
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::host, kTenKilohertz}));
  EXPECT_EQ(bench.code(FirmwareBench::begin_of(64)), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Tracking{}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::wrong_state);
}

TEST(FirmwareChange, AFaultTakesNoNextOne) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  bench.board.enabled = false;
  bench.run(100);
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(FirmwareBench::begin_of(64)), AnswerCode::wrong_state);
  EXPECT_EQ(bench.board.drive_v, 0);
}

// Otherwise a new host would arm the texture that played before.
TEST(FirmwareChange, OnTheWayToIdleNothingBegins) {
  FirmwareBench bench;
  bench.play_profile(5);
  bench.expect_ok(bench.code(wire::Disarm{}));
  EXPECT_EQ(bench.firmware->drive_state(), DriveState::playing);
  EXPECT_EQ(bench.code(FirmwareBench::begin_of(64)), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::wrong_state);
}

TEST(FirmwareChange, ArmedAgainItPlaysTheNewOne) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  bench.expect_ok(bench.code(wire::Change{5}));
  bench.run(100);  // long before the end of the change
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(100);
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(60);
  EXPECT_EQ(bench.board.drive_v, 2);
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::incomplete) << "a change of before is none of now";
  bench.upload_constant(3);
  bench.expect_ok(bench.code(wire::Change{0}));
  bench.run(10);
  EXPECT_EQ(bench.board.drive_v, 3);
}

TEST(FirmwareChange, ANextOneThatWasNotTakenIsForgottenByArming) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(100);
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
  EXPECT_EQ(bench.code(wire::Change{0}), AnswerCode::incomplete);
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(60);
  EXPECT_EQ(bench.board.drive_v, 1);
}

TEST(FirmwareChange, InIdleAProfileHasAllTheMemoryAgain) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.upload_constant(2);
  bench.expect_ok(bench.code(wire::Change{0}));
  bench.run(10);
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(100);
  bench.upload(std::vector<float>(kRoom, 3));
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(60);
  EXPECT_EQ(bench.board.drive_v, 3);
}

// Two levels of 32 samples, 1 V and 3 V; from 2 counts per tick on, twice the speed of full detail, the
// second one plays.
TEST(FirmwareChange, LevelsAndTheirSpeedComeWithIt) {
  for (const bool told : {true, false}) {
    FirmwareBench bench;
    bench.play_profile(1);
    std::vector<float> levels(64, 1);
    std::fill(levels.begin() + 32, levels.end(), 3.0F);
    bench.expect_ok(bench.code(FirmwareBench::begin_of(64)));
    bench.expect_ok(bench.code(wire::ProfileLevels{2, wire::Interpolation::linear, 0, 32}));
    bench.upload_samples(levels);
    if (told) bench.expect_ok(bench.code(wire::Tracking{0, {}, 0, 1, 1}));
    move_on(bench, 2, 300);
    EXPECT_EQ(bench.board.drive_v, 1) << "of the running one nothing changes before";
    bench.expect_ok(bench.code(wire::Change{0.001F}));
    move_on(bench, 2, 100);
    EXPECT_NEAR(bench.board.drive_v, told ? 3 : 1, 0.1);
  }
}

}  // namespace
}  // namespace tacto::core

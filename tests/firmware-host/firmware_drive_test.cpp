// SPDX-License-Identifier: GPL-3.0-or-later
// The drive: its states, its sources, and its return to zero in the stated time after every fault.
#include <gtest/gtest.h>

#include "tests/firmware-host/firmware_bench.hpp"

namespace tacto::core {
namespace {

using tests::FirmwareBench;
using tests::kTenKilohertz;
using tests::kTestLimits;
using wire::AnswerCode;
using wire::DriveState;
using wire::FaultCode;

// release_s + drive_v / slew_v_per_s + 2 ticks of the test's limits: 5 ms + 0.32 ms + 0.2 ms.
constexpr int kTicksToZero = 55;

wire::Drive constant_drive(std::uint16_t count, float drive_v) {
  wire::Drive drive{};
  drive.count = count;
  std::fill(drive.drive_v, drive.drive_v + count, drive_v);
  return drive;
}

// The largest step of the release from this drive: the largest slope of the envelope's weight is 1.5.
float release_step_v(float from_v) {
  return 1.5F * std::abs(from_v) / (kTestLimits.release_s * 10000);
}

constexpr float kSlewStepV = kTestLimits.slew_v_per_s / 10000;

void expect_ramp_to_zero(FirmwareBench& bench, float from_v, float largest_step_v) {
  const float step_v = largest_step_v * 1.0001F;
  float before_v = from_v;
  for (const float drive_v : bench.drives) {
    EXPECT_LE(std::abs(drive_v), std::abs(before_v)) << "never up again";
    EXPECT_LE(std::abs(drive_v - before_v), step_v) << "never with a step";
    before_v = drive_v;
  }
  for (std::size_t i = kTicksToZero; i < bench.drives.size(); ++i) EXPECT_EQ(bench.drives[i], 0);
  EXPECT_EQ(bench.board.drive_v, 0);
}

TEST(FirmwareDrive, GoesFromIdleToPlayingAndBack) {
  FirmwareBench bench;
  bench.arm_profile(2);
  EXPECT_EQ(bench.pulse().state, DriveState::armed);
  bench.run(50);
  EXPECT_EQ(bench.board.drive_v, 0) << "armed is silent";
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(10);
  EXPECT_GT(bench.board.drive_v, 0);
  EXPECT_LT(bench.board.drive_v, 1.9F) << "soft onset";
  bench.run(30);
  EXPECT_EQ(bench.board.drive_v, 2);
  EXPECT_EQ(bench.pulse().state, DriveState::playing);
  bench.expect_ok(bench.code(wire::Stop{}));
  bench.run(kTicksToZero);
  EXPECT_EQ(bench.board.drive_v, 0);
  EXPECT_EQ(bench.pulse().state, DriveState::armed);
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(2);
  EXPECT_EQ(bench.pulse().state, DriveState::idle);
  EXPECT_EQ(bench.board.rate_millihertz, 0U);
}

TEST(FirmwareDrive, GainIsLive) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.expect_ok(bench.code(wire::Gain{-1.5F}));
  bench.drives.clear();
  bench.run(110);
  EXPECT_EQ(bench.board.drive_v, -1.5F);
  for (std::size_t i = 1; i < bench.drives.size(); ++i)  // 2.5 V over 100 ticks
    EXPECT_LT(std::abs(bench.drives[i] - bench.drives[i - 1]), 0.026F) << i;
}

TEST(FirmwareDrive, StreamsEveryTick) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.run(1000);
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(100);
  ASSERT_EQ(bench.ticks.size(), bench.first_ticks.back() + (bench.ticks.size() - bench.first_ticks.back()));
  std::uint64_t tick = 0;
  for (std::size_t i = 0; i < bench.ticks.size(); ++i, ++tick)
    ASSERT_EQ(bench.ticks[i].drive_v, bench.drives[i]) << i;
  EXPECT_NE(bench.ticks[500].flags & wire::kTickPlaying, 0U);
  EXPECT_NE(bench.ticks[500].flags & wire::kTickEnabled, 0U);
}

TEST(FirmwareDrive, NothingChangesUnderARunningDrive) {
  FirmwareBench bench;
  bench.play_profile(1);
  EXPECT_EQ(bench.code(kTestLimits), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Taps{}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Energy{}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Contact{}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Filters{}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::StreamStart{5'000'000, 32}), AnswerCode::wrong_state) << "another rate";
  EXPECT_EQ(bench.code(wire::Reset{}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.board.restarts, 0U);
}

TEST(FirmwareDrive, RecordsWhileItPlays) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.expect_ok(bench.code(wire::StreamStart{kTenKilohertz, 32}));
  bench.run(320);
  bench.expect_ok(bench.code(wire::StreamStop{}));
  std::size_t frames = 0;
  for (const wire::Samples& block : bench.samples) frames += block.count;
  EXPECT_EQ(frames, 320U);
  EXPECT_EQ(bench.pulse().state, DriveState::playing);
  EXPECT_EQ(bench.board.rates_set, 1U) << "the drive's ticks were not interrupted";
}

TEST(FirmwareDrive, ASilentHostIsAFaultAndZero) {
  FirmwareBench bench;
  bench.play_profile(5);
  bench.drives.clear();
  bench.run(430, false);
  EXPECT_EQ(bench.board.drive_v, 5) << "the watchdog's 50 ms are not over";
  bench.drives.clear();
  bench.run(200, false);
  bench.drives.erase(bench.drives.begin(),
                     std::find_if(bench.drives.begin(), bench.drives.end(), [](float v) { return v < 5; }));
  EXPECT_NEAR(200 - static_cast<double>(bench.drives.size()), 500 - 59 - 430 + 1, 1);
  expect_ramp_to_zero(bench, 5, release_step_v(5));
  ASSERT_EQ(bench.faults.size(), 1U);
  EXPECT_EQ(bench.faults[0].code, FaultCode::host_silent);
  EXPECT_EQ(bench.pulse().state, DriveState::fault);
}

TEST(FirmwareDrive, AnOpenEnableInputIsAFaultAndZeroEvenIfItClosesAgain) {
  FirmwareBench bench;
  bench.play_profile(-4);
  bench.drives.clear();
  bench.board.enabled = false;
  bench.run(1);
  bench.board.enabled = true;
  bench.run(100);
  expect_ramp_to_zero(bench, -4, release_step_v(-4));
  EXPECT_EQ(bench.faults.at(0).code, FaultCode::enable_open);
  EXPECT_EQ(bench.code(wire::Play{}), AnswerCode::wrong_state);
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(2);
  EXPECT_EQ(bench.pulse().state, DriveState::idle);
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
}

TEST(FirmwareDrive, AnEncodersJumpIsAFaultAndZero) {
  for (const std::int32_t jump : {101, -101, std::numeric_limits<std::int32_t>::min()}) {
    FirmwareBench bench;
    bench.play_profile(3);
    bench.board.encoder = 100;
    bench.run(1);
    EXPECT_TRUE(bench.faults.empty());
    bench.board.encoder += jump;
    bench.drives.clear();
    bench.run(100);
    // The farthest place is outside the profile, where the target is zero.
    expect_ramp_to_zero(bench, 3, jump == 101 || jump == -101 ? release_step_v(3) : kSlewStepV);
    EXPECT_EQ(bench.faults.at(0).code, FaultCode::encoder_jump);
  }
}

TEST(FirmwareDrive, ATickWhileItIsArmedIsNoJump) {
  FirmwareBench bench;
  bench.board.encoder = 100'000;
  bench.expect_ok(bench.code(kTestLimits));
  bench.upload_constant(3);
  bench.board.interrupted = bench.firmware.get();
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
  bench.run(10);
  EXPECT_EQ(bench.board.interrupted, nullptr);
  EXPECT_TRUE(bench.faults.empty());
  EXPECT_EQ(bench.pulse().state, DriveState::armed);
}

// The counter has 32 bits: after 2^31 - 1 comes -2^31, and the way from one to the other is one count.
TEST(FirmwareDrive, TheEncodersWrapIsNoJump) {
  for (const int way : {1, -1, 100, -100}) {
    FirmwareBench bench;
    const auto end =
        way > 0 ? std::numeric_limits<std::int32_t>::max() : std::numeric_limits<std::int32_t>::min();
    bench.board.encoder = end - way / 2;
    bench.play_profile(3);
    bench.board.encoder = static_cast<std::int32_t>(static_cast<std::uint32_t>(bench.board.encoder) +
                                                    static_cast<std::uint32_t>(way));
    bench.run(100);
    EXPECT_TRUE(bench.faults.empty()) << way;
    EXPECT_EQ(bench.pulse().state, DriveState::playing) << way;
  }
}

// Ten counts after ten missing periods are one count per period, which is no jump.
TEST(FirmwareDrive, AfterPeriodsWithoutACountAJumpIsMeasuredByThem) {
  for (const std::int32_t way : {1000, 1001}) {
    FirmwareBench bench;
    bench.play_profile(3);
    bench.board.encoder += way;
    bench.board.encoder_unseen = 9;
    bench.run(1);
    bench.board.encoder_unseen = 0;
    bench.run(100);
    EXPECT_EQ(bench.pulse().state, way > 1000 ? DriveState::fault : DriveState::playing);
  }
}

// 0.1 s without counts at 10 kHz: the drive falls within the release time, waits, accepts any next count, and
// rises again.
TEST(FirmwareDrive, WithoutACountTheDriveFallsAndComesBackWithoutAJump) {
  FirmwareBench bench;
  bench.play_profile(3);
  bench.drives.clear();
  bench.ticks.clear();
  for (std::uint32_t away = 1; away <= 1000; ++away) {
    bench.board.encoder_unseen = away;
    bench.run(1);
  }
  bench.board.encoder += 1'000'000;
  bench.run(1);
  bench.board.encoder_unseen = 0;
  bench.run(400);
  EXPECT_EQ(bench.drives[99], 3.0F);   // 10 ms are tolerated
  EXPECT_EQ(bench.drives[160], 0.0F);  // 5 ms for the fall
  EXPECT_EQ(bench.drives[1000], 0.0F);
  EXPECT_EQ(bench.drives.back(), 3.0F);
  float largest_step = 0;
  for (std::size_t i = 1; i < bench.drives.size(); ++i)
    largest_step = std::max(largest_step, std::abs(bench.drives[i] - bench.drives[i - 1]));
  EXPECT_LE(largest_step, 3 * 1.51F / 20);  // an onset of 2 ms; the largest slope of the weight is 1.5
  EXPECT_TRUE(bench.faults.empty());
  const auto blind = std::ranges::count_if(
      bench.ticks, [](const wire::Tick& tick) { return (tick.flags & wire::kTickBlind) != 0; });
  EXPECT_EQ(blind, 901);
}

// 1e38 is finite; ten times that is not.
TEST(FirmwareDrive, AFilteredDriveThatIsNoNumberIsAFaultAndZero) {
  FirmwareBench bench;
  bench.play_profile(2);
  bench.expect_ok(bench.code(wire::Gain{2e38F}));
  for (int i = 0; i < 100 && bench.faults.empty(); ++i) {  // while the gain rises
    bench.drives.clear();
    bench.run(1);
  }
  bench.run(100);
  ASSERT_EQ(bench.faults.size(), 1U);
  EXPECT_EQ(bench.faults.at(0).code, FaultCode::not_a_number);
  expect_ramp_to_zero(bench, 5, kSlewStepV);
}

TEST(FirmwareDrive, AFaultIsToldOnceAndEndsWithDisarm) {
  FirmwareBench bench;
  bench.play_profile(2);
  bench.board.enabled = false;
  bench.run(1000);
  EXPECT_EQ(bench.faults.size(), 1U);
  bench.board.enabled = true;
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(2);
  bench.play_profile(2);
  EXPECT_EQ(bench.board.drive_v, 2);
  EXPECT_EQ(bench.faults.size(), 1U);
}

TEST(FirmwareDrive, HelloEndsWhateverRan) {
  FirmwareBench bench;
  bench.play_profile(2);
  bench.drives.clear();
  bench.greet();
  bench.run(60, false);
  expect_ramp_to_zero(bench, 2, release_step_v(2));
  EXPECT_EQ(bench.firmware->drive_state(), DriveState::idle);
}

TEST(FirmwareDrive, PlaysTheHostsDriveInItsTime) {
  FirmwareBench bench;
  bench.expect_ok(bench.code(kTestLimits));
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::host, kTenKilohertz}));
  bench.expect_ok(bench.code(wire::Play{}));
  for (int i = 0; i < 10; ++i) {
    bench.send(constant_drive(100, 1));
    bench.run(100);
  }
  EXPECT_EQ(bench.board.drive_v, 1);
  EXPECT_TRUE(bench.answers.back().of != wire::MessageType::drive);
  bench.drives.clear();
  bench.run(60);
  EXPECT_EQ(bench.board.drive_v, 0) << "no drive, no output";
  EXPECT_TRUE(bench.faults.empty());
  EXPECT_GE(bench.pulse().underruns, 60U);
  bench.run(500);
  EXPECT_EQ(bench.faults.at(0).code, FaultCode::drive_underrun);
}

TEST(FirmwareDrive, AStaleDriveIsNeverPlayed) {
  FirmwareBench bench;
  bench.expect_ok(bench.code(kTestLimits));
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::host, kTenKilohertz}));
  bench.send(constant_drive(300, 4));
  bench.run(300);
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(100);
  EXPECT_EQ(*std::max_element(bench.drives.begin(), bench.drives.end()), 0);
}

TEST(FirmwareDrive, MoreDriveThanItHoldsIsRefusedWhole) {
  FirmwareBench bench;
  bench.expect_ok(bench.code(kTestLimits));
  EXPECT_EQ(bench.code(constant_drive(10, 1)), AnswerCode::wrong_state);
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::host, kTenKilohertz}));
  bench.send(constant_drive(512, 1));
  bench.send(constant_drive(511, 1));
  EXPECT_EQ(bench.command(constant_drive(2, 1)).detail, 1U);
  EXPECT_EQ(bench.pulse().drive_queued, 1023U);
}

TEST(FirmwareDrive, SweepsWithinItsLimitsAndEnds) {
  FirmwareBench bench;
  bench.expect_ok(bench.code(kTestLimits));
  bench.expect_ok(bench.code(wire::Sweep{1, 10'000, 800'000, 1'880'000}));
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::sweep, kTenKilohertz}));
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(9000);
  EXPECT_NEAR(*std::max_element(bench.drives.begin(), bench.drives.end()), 1, 1e-3);
  bench.run(2000);
  EXPECT_EQ(bench.board.drive_v, 0);
}

// release_s, 5 ms, whatever ends it: half the level after half of the release, and no step above the
// envelope's steepest, 1.5 / 50 ticks. Near the maximum of 2 V of a sine of 10 Hz, which falls by 5 % in the
// meantime.
TEST(FirmwareDrive, ASweepFallsOverItsRelease) {
  constexpr int kReleaseTicks = 50;
  for (const char* how : {"stop", "disarm", "enable input"}) {
    FirmwareBench bench;
    bench.expect_ok(bench.code(kTestLimits));
    bench.expect_ok(bench.code(wire::Sweep{2, 10'000, 11'000, 188'000}));
    bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::sweep, kTenKilohertz}));
    bench.run(20);
    EXPECT_EQ(bench.board.drive_v, 0) << "armed is silent";
    bench.expect_ok(bench.code(wire::Play{}));
    bench.run(245);
    float before_v = bench.board.drive_v;
    ASSERT_NEAR(before_v, 2, 0.02);
    bench.drives.clear();
    if (how == std::string("stop")) bench.expect_ok(bench.code(wire::Stop{}));
    if (how == std::string("disarm")) bench.expect_ok(bench.code(wire::Disarm{}));
    if (how == std::string("enable input")) bench.board.enabled = false;
    bench.run(kTicksToZero);
    ASSERT_GE(bench.drives.size(), kReleaseTicks + 1U) << how;
    EXPECT_NEAR(bench.drives[kReleaseTicks / 2], 1, 0.15) << how;
    for (const float drive_v : bench.drives) {
      EXPECT_LE(std::abs(drive_v - before_v), 2 * 1.5 / kReleaseTicks * 1.05) << how;
      before_v = drive_v;
    }
    EXPECT_EQ(bench.board.drive_v, 0) << how;
  }
}

TEST(FirmwareDrive, LateTicksAreCountedAndMarked) {
  FirmwareBench bench;
  bench.play_profile(1);
  bench.board.clock += tests::kTestClockHz / 10000;
  bench.run(50);
  EXPECT_EQ(bench.pulse().late_ticks, 1U);
}

TEST(FirmwareDrive, ABoardWithoutOutputIsNeverArmed) {
  tests::TestBoard board;
  core::Board about = board.about();
  about.about.features = 0;
  FirmwareBench bench;
  bench.firmware = std::make_unique<Firmware>(about, bench.board.hal());
  bench.greet();
  bench.expect_ok(bench.code(kTestLimits));
  EXPECT_EQ(bench.code(wire::Arm{wire::DriveSource::host, kTenKilohertz}), AnswerCode::bad_value);
}

}  // namespace
}  // namespace tacto::core

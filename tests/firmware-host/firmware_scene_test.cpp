// SPDX-License-Identifier: GPL-3.0-or-later
// The firmware of a device with forces: description, upload, ticks of two axes, `set` with a ramp, limits,
// faults.
#include <gtest/gtest.h>

#include <cmath>

#include "firmware-host/core/scene/scene_block.hpp"
#include "tests/firmware-host/firmware_bench.hpp"

namespace tacto::core {
namespace {

using tests::FirmwareBench;
using wire::AnswerCode;

constexpr std::uint32_t kKilohertz = 1'000'000;
constexpr wire::ForceLimits kLimits{{20, 20, 0}, {5, 5, 0}, 20, 5, 20000, 0.002F, 0.002F, 50, 0, 2000};

// One patch of 0.2 m with a spring of 100 N/m and a damper of 0.
struct Block {
  SceneHeader header;
  ScenePatch patch;
  SceneLayer layers[2];
  float numbers[4];
};

Block block_of(float stiffness) {
  Block block{{}, {0, 0, 1, 0, 0.1F, 0.1F, 0, 2, 0}, {{0, 0}, {1, 3}}, {stiffness, 0, 0, 0}};
  block.header.patches = 1, block.header.layers = 2, block.header.numbers = 4;
  block.header.check = scene_check(&block, sizeof block);
  return block;
}

struct SceneBench : FirmwareBench {
  SceneBench() : FirmwareBench(WithForces{}) {}

  AnswerCode upload(const Block& block) { return upload_scene(&block, sizeof block); }
  void play_spring(float stiffness) {
    expect_ok(code(kLimits));
    expect_ok(upload(block_of(stiffness)));
    expect_ok(code(wire::Arm{wire::DriveSource::scene, kKilohertz}));
    expect_ok(code(wire::Play{}));
    run(10);
  }
};

TEST(FirmwareScene, AxesAreDescribedAfterTheWelcome) {
  SceneBench bench;
  ASSERT_EQ(bench.axes.size(), 1U);
  EXPECT_EQ(bench.axes[0].count, 2);
  EXPECT_EQ(bench.axes[0].axes[1].along, wire::AxisAlong::y);
  EXPECT_EQ(bench.axes[0].scene_bytes, 9600U);  // 4096 words less 256 x (3 numbers + 3), 16 x 10 of bodies
  EXPECT_NE(bench.welcomes[0].features & wire::kFeatureForces, 0U);
  EXPECT_EQ(bench.order[1], wire::MessageType::axes);
  EXPECT_EQ(bench.channels.size(), 2U);
  EXPECT_EQ(bench.notes.size(), 1U);
  FirmwareBench tray;
  EXPECT_TRUE(tray.axes.empty());
  EXPECT_EQ(tray.welcomes[0].features & wire::kFeatureForces, 0U);
  EXPECT_EQ(tray.code(kLimits), AnswerCode::unknown_type);
  EXPECT_EQ(tray.code(wire::Arm{wire::DriveSource::scene, kKilohertz}), AnswerCode::bad_value);
}

TEST(FirmwareScene, TicksHaveTheCountsAndForcesOfAllAxes) {
  SceneBench bench;
  bench.play_spring(100);
  bench.axis_ticks.clear();
  bench.board.counts[0] = 1000, bench.board.counts[1] = -500;  // 10 mm, -5 mm
  bench.run(30);
  ASSERT_GE(bench.axis_ticks.size(), 20U);
  const wire::AxisTick& tick = bench.axis_ticks.back();
  EXPECT_EQ(tick.counts[0], 1000);
  EXPECT_EQ(tick.counts[1], -500);
  EXPECT_NEAR(tick.force_n[0], -1, 1e-6);
  EXPECT_NEAR(tick.force_n[1], 0.5, 1e-6);
  EXPECT_EQ(tick.flags & 7U, wire::kTickEnabled | wire::kTickPlaying);
  EXPECT_EQ(bench.board.force_n[0], tick.force_n[0]);
  EXPECT_TRUE(bench.ticks.empty());
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(10);
  EXPECT_EQ(bench.firmware->drive_state(), wire::DriveState::idle);
  EXPECT_EQ(bench.board.force_n[0], 0);
}

TEST(FirmwareScene, SetRampsLinearlyFromTheTickThatCountsIt) {
  SceneBench bench;
  bench.play_spring(100);
  bench.board.counts[0] = 1000;
  bench.run(30);
  bench.axis_ticks.clear();
  bench.expect_ok(bench.code(wire::Set{0, 0, 300, 0.01F}));  // 10 ticks
  bench.run(30);
  std::size_t first = 0;
  while (bench.axis_ticks[first].flags >> wire::kTickSteeredShift < 2) ++first;  // play, set
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(bench.axis_ticks[first + i].force_n[0], -1 - 0.2 * static_cast<double>(i + 1), 1e-5) << i;
  EXPECT_NEAR(bench.axis_ticks[first + 12].force_n[0], -3, 1e-6);
  EXPECT_EQ(bench.code(wire::Set{2, 0, 1, 0}), AnswerCode::bad_value);   // no such layer
  EXPECT_EQ(bench.code(wire::Set{1, 1, 1, 0}), AnswerCode::bad_value);   // no such number
  EXPECT_EQ(bench.code(wire::Set{0, 0, -1, 0}), AnswerCode::bad_value);  // out of its range
  EXPECT_EQ(bench.code(wire::Set{0, 0, std::nanf(""), 0}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::Set{0, 0, 1, 11}), AnswerCode::bad_value);
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(20);
  EXPECT_EQ(bench.code(wire::Set{0, 0, 1, 0}), AnswerCode::wrong_state);
  // Armed again, the scene has the numbers of its block.
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::scene, kKilohertz}));
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(30);
  EXPECT_NEAR(bench.board.force_n[0], -1, 1e-6);
}

TEST(FirmwareScene, MoveStepsByWholeCountsFromTheTickThatCountsIt) {
  SceneBench bench;
  bench.play_spring(100);
  bench.board.counts[0] = 1000;
  bench.run(30);
  bench.axis_ticks.clear();
  bench.expect_ok(bench.code(wire::Move{0, 0, -407, 93, 0.01F}));  // 10 ticks
  bench.run(30);
  std::size_t first = 0;
  while (bench.axis_ticks[first].flags >> wire::kTickSteeredShift < 2) ++first;  // play, move
  for (int k = 1; k <= 12; ++k) {
    const int part = std::min(k, 10), x = 1000 + 407 * part / 10, y = -(93 * part / 10);
    const wire::AxisTick& tick = bench.axis_ticks[first + static_cast<std::size_t>(k) - 1];
    EXPECT_FLOAT_EQ(tick.force_n[0], -100 * (static_cast<float>(x) * 1e-5F)) << k;
    EXPECT_FLOAT_EQ(tick.force_n[1], -100 * (static_cast<float>(y) * 1e-5F)) << k;
  }
  // A second move begins where the patch is, and a third one of no time is complete in its first tick.
  bench.expect_ok(bench.code(wire::Move{0, 0, 0, 0, 0.01F}));
  bench.run(5);
  bench.expect_ok(bench.code(wire::Move{0, 0, 500, 0, 0}));
  bench.run(20);
  EXPECT_FLOAT_EQ(bench.board.force_n[0], -100 * (500 * 1e-5F));
  constexpr std::int32_t kFar = kFarthestMove;
  bench.expect_ok(bench.code(wire::Move{0, 0, -kFar, kFar, 0}));
  bench.run(20);
  bench.expect_ok(bench.code(wire::Move{0, 0, kFar, -kFar, 0}));
  bench.run(20);
  EXPECT_FLOAT_EQ(bench.board.force_n[0], 0);                               // the patch is elsewhere
  EXPECT_EQ(bench.code(wire::Move{1, 0, 0, 0, 0}), AnswerCode::bad_value);  // no such patch
  EXPECT_EQ(bench.code(wire::Move{0, 0, kFar + 1, 0, 0}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::Move{0, 0, 0, -kFar - 1, 0}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::Move{0, 0, 0, 0, 11}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::Move{0, 0, 0, 0, std::nanf("")}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::Raise{1}), AnswerCode::bad_value);
  bench.expect_ok(bench.code(wire::Raise{0}));
  bench.expect_ok(bench.code(wire::Disarm{}));
  bench.run(20);
  EXPECT_EQ(bench.code(wire::Move{0, 0, 0, 0, 0}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Raise{0}), AnswerCode::wrong_state);
  // Armed again, the patch is at its place.
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::scene, kKilohertz}));
  bench.expect_ok(bench.code(wire::Play{}));
  bench.run(30);
  EXPECT_FLOAT_EQ(bench.board.force_n[0], -100 * (1000 * 1e-5F));
}

TEST(FirmwareScene, ASilentHostAnOpenInputAndAJumpEndTheForces) {
  for (int fault = 0; fault < 3; ++fault) {
    SceneBench bench;
    bench.play_spring(100);
    bench.board.counts[0] = 1000;
    bench.run(30);
    EXPECT_NEAR(bench.board.force_n[0], -1, 1e-6);
    if (fault == 0) bench.run(51, false);
    if (fault == 1) bench.board.enabled = false;
    if (fault == 2) bench.board.counts[1] += 2001;
    bench.run(20, fault != 0);  // 20 ms
    EXPECT_EQ(bench.firmware->drive_state(), wire::DriveState::fault) << fault;
    EXPECT_EQ(bench.board.force_n[0], 0) << fault;
    EXPECT_EQ(bench.board.force_n[1], 0) << fault;
    const wire::FaultCode codes[] = {wire::FaultCode::host_silent, wire::FaultCode::enable_open,
                                     wire::FaultCode::encoder_jump};
    ASSERT_FALSE(bench.faults.empty());
    EXPECT_EQ(bench.faults[0].code, codes[fault]);
  }
}

TEST(FirmwareScene, NothingIsArmedWithoutLimitsAndAWholeScene) {
  SceneBench bench;
  const wire::Arm arm{wire::DriveSource::scene, kKilohertz};
  EXPECT_EQ(bench.code(arm), AnswerCode::no_limits);
  wire::ForceLimits wish = kLimits;
  wish.axis_peak_n[1] = 21;
  EXPECT_EQ(bench.code(wish), AnswerCode::bad_value);
  wish = kLimits;
  wish.release_s = 0.018F;
  EXPECT_EQ(bench.code(wish), AnswerCode::bad_value);
  bench.expect_ok(bench.code(kLimits));
  EXPECT_EQ(bench.code(arm), AnswerCode::incomplete);
  Block damaged = block_of(100);
  damaged.numbers[0] = 101;
  EXPECT_EQ(bench.upload(damaged), AnswerCode::check_failed);
  EXPECT_EQ(bench.code(arm), AnswerCode::incomplete);
  wire::ScenePart late{};
  late.bytes = sizeof(Block), late.first = 16, late.count = 4;
  bench.expect_ok(bench.code([] {
    wire::ScenePart part{};
    part.bytes = sizeof(Block), part.count = 4;
    return part;
  }()));
  EXPECT_EQ(bench.code(late), AnswerCode::incomplete);
  bench.expect_ok(bench.upload(block_of(100)));
  bench.upload_constant(1);  // a profile takes the memory
  EXPECT_EQ(bench.code(arm), AnswerCode::incomplete);
  bench.expect_ok(bench.upload(block_of(100)));
  bench.expect_ok(bench.code(arm));
}

}  // namespace
}  // namespace tacto::core

// SPDX-License-Identifier: GPL-3.0-or-later
// Checks with a hook on every allocation that neither tick() nor poll() allocates: while playing, streaming,
// receiving messages, and in fault; and under seccomp that neither makes a system call in a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "tests/firmware-host/allocation_hook.hpp"
#include "tests/firmware-host/firmware_bench.hpp"
#include "tests/firmware-host/kernel_workload.hpp"
#include "tests/firmware-host/pieces_workload.hpp"
#include "tests/firmware-host/seccomp.hpp"
#include "tests/firmware-host/volume_workload.hpp"

namespace tacto::core {
namespace {

static_assert(noexcept(std::declval<Firmware&>().tick()));
static_assert(noexcept(std::declval<Firmware&>().poll()));
static_assert(noexcept(std::declval<TickKernel&>().tick(TickInput{})));
static_assert(noexcept(std::declval<TickKernel&>().change(TextureSetup{}, 1)));
static_assert(noexcept(std::declval<TickKernel&>().drive(0, true, kNoForce)));

TEST(Allocation, TheHookSeesAllocations) {
  const long before = tests::allocations_here();
  ::operator delete(::operator new(8));
  EXPECT_EQ(tests::allocations_here(), before + 1);
}

TEST(Allocation, NeitherTickNorPollAllocates) {
  tests::FirmwareBench bench;
  bench.play_profile(2);
  bench.expect_ok(bench.code(wire::StreamStart{tests::kTenKilohertz, 32}));
  bench.upload_constant(-1);
  bench.board.to_host.reserve(10'000'000);
  const auto say = [&](const auto& message) {
    const auto frame = tests::framed(message, bench.sequence_++);
    bench.board.from_host.insert(bench.board.from_host.end(), frame.begin(), frame.end());
  };
  say(wire::Change{0.1F});
  say(wire::Heartbeat{1});
  const long before = tests::allocations_here();
  for (int i = 0; i < 5000; ++i) {
    bench.board.clock += tests::kTestClockHz / 10000;
    bench.board.encoder += 1;
    bench.board.enabled = i < 4000;
    bench.firmware->tick();
    bench.firmware->poll();
  }
  EXPECT_EQ(tests::allocations_here(), before);
  EXPECT_GT(bench.board.to_host.size(), 100'000U);
}

TEST(Allocation, TheKernelDoesNotAllocate) {
  static tests::KernelWorkload workload;
  static tests::TextureWorkload texture;
  const long before = tests::allocations_here();
  for (int i = 0; i < 1000; ++i) workload.tick();
  for (int i = 0; i < 20000; ++i) texture.tick();
  EXPECT_EQ(tests::allocations_here(), before);
}

template <class Workload>
void expect_ticks_without_calls(std::uint32_t fingerprint) {
  static Workload workload;
  const int status = tests::status_under_seccomp([&] {
    const long before = tests::allocations_here();
    tests::DriveFingerprint forces;
    for (std::uint32_t i = 0; i < tests::kWorkloadTicks; ++i) forces.add(workload.tick());
    return tests::allocations_here() == before && forces.value() == fingerprint;
  });
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Scenes, TheWorkloadsHaveAllKindsOfLayers) {
  const auto has = [](const auto& kinds, std::uint16_t kind) {
    return std::find(std::begin(kinds), std::end(kinds), kind) != std::end(kinds);
  };
  for (std::uint16_t kind = 0; kind < 1000; ++kind)
    EXPECT_EQ(has(tests::SceneWorkload::kKinds, kind) || has(tests::PiecesWorkload::kKinds, kind) ||
                  has(tests::VolumeWorkload::kKinds, kind),
              is_known(static_cast<SceneLayerKind>(kind)))
        << kind;
}

TEST(Scenes, UnderSeccompASystemCallEndsTheProcess) {
  EXPECT_TRUE(WIFSIGNALED(tests::status_under_seccomp([] { return getppid() > 0; })));
}

// With changes of place and order while they play.
TEST(Scenes, NoTickOfTheKernelAllocatesOrCallsTheSystem) {
  expect_ticks_without_calls<tests::SceneWorkload>(tests::kSceneFingerprint);
  expect_ticks_without_calls<tests::PiecesWorkload>(tests::kPiecesFingerprint);
  expect_ticks_without_calls<tests::VolumeWorkload>(tests::kVolumeFingerprint);
}

TEST(Scenes, NoTickOrPollOfTheFirmwareAllocatesOrCallsTheSystem) {
  static const tests::SceneWorkload scene;
  tests::FirmwareBench bench{tests::FirmwareBench::WithForces{}};
  bench.expect_ok(
      bench.code(wire::ForceLimits{{20, 20, 0}, {5, 5, 0}, 20, 5, 20000, 0.002F, 0.002F, 1000, 0, 2000}));
  bench.expect_ok(bench.upload_scene(&scene.block(), sizeof scene.block()));
  bench.expect_ok(bench.code(wire::Arm{wire::DriveSource::scene, 4 * tests::kTenKilohertz / 10}));
  bench.expect_ok(bench.code(wire::Play{}));
  bench.board.to_host.reserve(10'000'000);
  const auto say = [&](const auto& message) {
    const auto frame = tests::framed(message, bench.sequence_++);
    bench.board.from_host.insert(bench.board.from_host.end(), frame.begin(), frame.end());
  };
  say(wire::Set{1, 0, 300, 0.1F});
  say(wire::Move{1, 0, 50, -50, 0.1F});
  say(wire::Raise{2});
  const int status = tests::status_under_seccomp([&] {
    const long before = tests::allocations_here();
    int pushed = 0;
    for (int i = 0; i < 3500; ++i) {
      bench.board.clock += tests::kTestClockHz / 4000;
      bench.board.counts[0] = i % 1000 - 500, bench.board.counts[1] = i % 700 - 350;
      bench.board.enabled = i < 3000;
      bench.firmware->tick();
      bench.firmware->poll();
      pushed += bench.board.force_n[0] != 0;
    }
    return tests::allocations_here() == before && pushed > 2500 && bench.board.to_host.size() > 10'000 &&
           bench.board.taken == bench.board.from_host.size();
  });
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace tacto::core

// SPDX-License-Identifier: GPL-3.0-or-later
// Checks with a hook on every allocation that neither tick() nor poll() allocates: while playing, streaming,
// receiving messages, and in fault.
#include <gtest/gtest.h>

#include "tests/firmware-host/allocation_hook.hpp"
#include "tests/firmware-host/firmware_bench.hpp"
#include "tests/firmware-host/kernel_workload.hpp"

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
  static tests::SceneWorkload scene;
  const long before = tests::allocations_here();
  for (int i = 0; i < 1000; ++i) workload.tick();
  for (int i = 0; i < 20000; ++i) texture.tick();
  for (int i = 0; i < 20000; ++i) scene.tick();
  EXPECT_EQ(tests::allocations_here(), before);
}

}  // namespace
}  // namespace tacto::core

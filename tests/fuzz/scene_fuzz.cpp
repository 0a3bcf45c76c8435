// SPDX-License-Identifier: GPL-3.0-or-later
// Any block of a scene, with a valid check, and any motion of the hand: the reader refuses the block, or the
// kernel's forces are finite numbers within the limits of the device. The input is 16 bytes of motion, then
// the block.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "firmware-host/core/scene/scene_kernel.hpp"

namespace {

using namespace tacto::core;

constexpr std::size_t kMotion = 16;

void demand(bool holds) {
  if (!holds) std::abort();
}

ForceSetup device() {
  ForceSetup setup;
  setup.axes[0] = {AxisAlong::x, 1e-5F, 20, 5};
  setup.axes[1] = {AxisAlong::z, 1e-3F, 9, 5};
  setup.axes[2] = {AxisAlong::y, 1, 12, 6};
  setup.axis_count = 3;
  setup.peak_n = 21;
  setup.continuous_n = 7;
  setup.slew_n_per_s = 3000;
  setup.rate_hz = 1000;
  setup.onset_s = setup.release_s = 0.003F;
  return setup;
}

void check(const ForceOutput& output, float (&last_n)[kMostAxes], const ForceSetup& setup) {
  double square = 0;
  demand(output.sound);
  for (std::uint32_t i = 0; i < setup.axis_count; ++i) {
    const float force_n = output.force_n[i];
    demand(std::abs(force_n) <= setup.axes[i].peak_n);
    demand(std::abs(force_n - last_n[i]) <= 3 * (1 + 1e-5F));
    last_n[i] = force_n;
    square += double{force_n} * force_n;
  }
  demand(std::sqrt(square) <= double{setup.peak_n} * (1 + 0x1p-22));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < kMotion + sizeof(SceneHeader)) return 0;
  std::int32_t motion[kMotion / 4];
  std::memcpy(motion, data, kMotion);
  const auto bytes = static_cast<std::uint32_t>(size - kMotion);
  std::vector<std::uint32_t> block((bytes + 3) / 4);
  std::memcpy(block.data(), data + kMotion, bytes);
  block[3] = scene_check(block.data(), bytes);
  SceneView view;
  if (read_scene_block(block.data(), bytes, view) != SceneFault::none) return 0;
  const ForceSetup setup = device();
  SceneKernel kernel;
  std::vector<float> live(view.live_words());
  kernel.set(view, setup, live.data());
  float last_n[kMostAxes] = {};
  std::uint32_t counts[kMostAxes] = {};
  for (std::uint32_t tick = 0; tick < 64; ++tick) {
    for (std::uint32_t i = 0; i < kMostAxes; ++i)
      counts[i] += static_cast<std::uint32_t>(motion[(tick + i) % 4]);
    if (view.patch_count > 0 && tick % 8 == 5) {
      const std::int32_t far[2] = {motion[tick / 8 % 4] % kFarthestMove,
                                   motion[tick / 16 % 4] % kFarthestMove};
      kernel.move(tick % view.patch_count, far, static_cast<float>(tick));
      kernel.raise((tick + 1) % view.patch_count);
    }
    std::int32_t read[kMostAxes];
    std::memcpy(read, counts, sizeof read);
    check(kernel.tick(read, tick % 16 < 12), last_n, setup);
  }
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of volumes that is ticked on every target: its forces have to be the same to the bit.
#pragma once

#include <stdint.h>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/core/scene/volume.hpp"
#include "tests/firmware-host/kernel_workload.hpp"

namespace tacto::tests {

inline constexpr uint32_t kVolumeFingerprint = 1154329669;

/// A volume that a tool of three points carves, a second one around it, and clay whose volume is kept, with a
/// wall's damper and friction.
class VolumeWorkload {
  static constexpr uint32_t kVolumes = 2, kLayers = 3, kWords = core::kPieceNumbers + core::kWallStateWords;

 public:
  static constexpr uint16_t kKinds[kLayers] = {24, 24, 22};
  VolumeWorkload() noexcept {
    constexpr uint32_t kCarved = sizeof(Carved) / sizeof(uint32_t), kWhole = sizeof(Whole) / sizeof(uint32_t),
                       kTables[kLayers] = {0, kCarved, kCarved + kWhole};
    block_.header.patches = 1, block_.header.layers = kLayers;
    block_.header.numbers = kLayers * kWords;
    block_.header.table_words = kTableWords;
    block_.patch = {0, 0, 1, 0, 1000, 1000, 0, kLayers, 0};
    const float wall[core::kPieceNumbers] = {800, 2, 0.05F, 0, 0, 0, 0.5F, 0.3F, 1, 1};
#pragma GCC unroll 1
    for (uint32_t i = 0; i < kLayers; ++i) {
      block_.layers[i] = {kKinds[i], static_cast<uint16_t>(i * kWords), kTables[i]};
      for (uint32_t j = 0; j < core::kPieceNumbers; ++j) block_.numbers[i * kWords + j] = wall[j];
    }
    WorkloadRandom value{10};
    core::VolumeTable* const tables[kVolumes] = {&block_.carved.table, &block_.whole.table};
    int16_t* const values[kVolumes] = {block_.carved.values, block_.whole.values};
    for (uint32_t i = 0; i < kVolumes; ++i) {
      core::VolumeTable& table = *tables[i];
      table.piece = {{static_cast<int32_t>(300 * i), -200, 100}, {1e-6F, 0, -2e-6F}, {0, 0, 1, 0.02F}, {}};
      for (core::VolumeAxis& axis : table.along) axis = {3, 1U << 31, 0, 8'589'935, 200, kSide};
      table.iso = -1000.5F;
      table.m_per_value = 2e-7F;
      for (uint32_t j = 0; j < kSide * kSide * kSide; ++j) values[i][j] = static_cast<int16_t>(value());
    }
    block_.carved.table.carve_n = 0.5F;
    block_.carved.table.carve_per_tick = 3U << 15;
    block_.carved.table.carve_to = -32768;
    block_.carved.table.points = 3;
    block_.carved.points[1] = {{0, 1, -1}, {7, 1U << 30, 9}};
    block_.carved.points[2] = {{-1, 0, 0}, {3U << 30, 0, 1U << 31}};
    auto& clay = block_.clay;
    clay.table = {{{0, 0, -500}, {}, {0, 0, 1}, {}}, {{0.8F, 0.6F, 0}, {-0.6F, 0.8F, 0}}, {}, 700};
    clay.table.clay = {1, 0x1p-14F, -0x1p-7F, 0x1p-7F, 1};
    clay.relief = {500, 1};
    clay.levels[0] = {{{4, 0, {}}, {4, 7, {}}}, {200, 200}, kClaySide, kClaySide, 0};
    value.fill(clay.heights, 0x1p-24F);
    const uint32_t bytes = sizeof block_;
    block_.header.check = core::scene_check(&block_, bytes);
    core::SceneView view;
    core::read_scene_block(&block_, bytes, view);
    core::ForceSetup setup;
    for (int i = 0; i < 3; ++i) setup.axes[i] = {static_cast<core::AxisAlong>(i), 1e-5F, 8, 4};
    setup.axis_count = 3, setup.peak_n = 10, setup.continuous_n = 5, setup.slew_n_per_s = 3000;
    setup.rate_hz = 1000;
    setup.onset_s = setup.release_s = 0.02F;
    kernel_.set(view, setup, live_);
  }

  /// One tick; the sum of the forces.
  float tick() noexcept {
    for (int i = 0; i < 3; ++i) {
      const int32_t draw = next_();
      if (draw % 100 == 0) speed_[i] = (draw >> 4) % 61;
      const int32_t away = speed_[i] < 0 ? -speed_[i] : speed_[i];
      if (counts_[i] > 2000) speed_[i] = -away;
      if (counts_[i] < -2000) speed_[i] = away;
      counts_[i] += speed_[i];
    }
    const auto output = kernel_.tick(counts_, ++ticks_ < kWorkloadTicks - 400);
    return output.force_n[0] + output.force_n[1] + output.force_n[2];
  }

 private:
  static constexpr uint32_t kSide = 8, kValues = kSide * kSide * kSide;
  static constexpr uint32_t kClaySide = 9;
  struct Carved {
    core::VolumeTable table;
    core::ToolPoint points[3];
    int16_t values[kValues] = {};
    int16_t largest[2] = {32767, 0};  // of its one block
  };
  struct Whole {
    core::VolumeTable table;
    int16_t values[kValues] = {};
  };
  struct Clay {
    core::ReliefPieceTable table;
    core::ReliefTable relief;
    core::ReliefLevelTable levels[1];
    float heights[kClaySide * kClaySide];  // all are set
  };
  static constexpr uint32_t kTableWords = (sizeof(Carved) + sizeof(Whole) + sizeof(Clay)) / sizeof(uint32_t);
  struct Block {
    core::SceneHeader header;
    core::ScenePatch patch;
    core::SceneLayer layers[kLayers];
    float numbers[kLayers * kWords] = {};
    Carved carved;
    Whole whole;
    Clay clay;
  } block_;
  WorkloadRandom next_{1999};
  uint32_t ticks_ = 0;
  int32_t counts_[3] = {}, speed_[3] = {};
  float live_[kLayers * kWords + core::kPatchWords + kTableWords];
  core::SceneKernel kernel_;
};

}  // namespace tacto::tests

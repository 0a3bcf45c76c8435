// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of pieces in space that is ticked on every target: its forces have to be the same to the bit.
#pragma once

#include <stdint.h>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "tests/firmware-host/kernel_workload.hpp"

namespace tacto::tests {

inline constexpr uint32_t kPiecesFingerprint = 2827787309;

/// A floor, a plate on edge, a ball, a pipe, an ellipsoid and a mesh, and a hand that is pushed through them
/// at up to 60 counts per tick; walls with dampers, arrest and integral; a recording on the floor, a bump map
/// on the ball, a sine on the pipe, which is a button; a raised plane below; the plate slides; all limits are
/// reached.
class PiecesWorkload {
  static constexpr uint32_t kPieces = 7, kWords = core::kPieceNumbers + core::kWallStateWords;

 public:
  static constexpr uint16_t kKinds[kPieces] = {16, 16, 17, 18, 19, 20, 22};
  PiecesWorkload() noexcept {
    block_.header.patches = 1, block_.header.layers = kPieces;
    block_.header.numbers = kPieces * kWords;
    block_.header.table_words = sizeof block_.tables / sizeof(uint32_t);
    block_.patch = {0, 0, 1, 0, 1000, 1000, 0, kPieces, 0};
#pragma GCC unroll 1
    for (uint32_t i = 0; i < kPieces; ++i) {
      block_.layers[i] = {kKinds[i], static_cast<uint16_t>(i * kWords), 0};
      const float wall[core::kPieceNumbers] = {2000, 4, 0.1F, 3000, 2, 0.5F, 0.6F, 0.4F, 1, 1};
      for (uint32_t j = 0; j < core::kPieceNumbers; ++j) block_.numbers[i * kWords + j] = wall[j];
    }
    auto& [floor, plate, ball, pipe, egg, mesh, raised] = block_.tables;
    const void* const tables[kPieces] = {&floor, &plate, &ball, &pipe, &egg, &mesh, &raised};
    for (uint32_t i = 0; i < kPieces; ++i)
      block_.layers[i].table = static_cast<uint32_t>(static_cast<const uint32_t*>(tables[i]) -
                                                     reinterpret_cast<const uint32_t*>(&block_.tables));
    floor.table = {{0, 0, -2000}, {1e-6F, 0, -3e-6F}, {0.28F, 0, 0.96F}, {}};
    plate.table = {{1500, 0, 0}, {}, {1, 0, 0, 0.001F}, {}};
    ball.table = {{-1000, 500, 0}, {}, {0, 0, 1, 0.01F}, {}};
    pipe.table = {{0, -2500, 500}, {}, {0.6F, 0, 0.8F, 0.008F}, {}};
    egg = {{300, 2000, 700}, {}, {1e4F, 2e4F, 4e4F, 1e3F, 0, 0, 0, 2, 0, -1}, {}};
    plate.table.slide = sizeof(core::PieceTable) / sizeof(uint32_t);
    plate.slide = {{1, 0, 0}, -0.01F, 0.01F, 0.01F, 0.95F, 0.2F, 0.5F, 400};
    floor.table.texture = ball.table.texture = pipe.table.travel =
        sizeof(core::PieceTable) / sizeof(uint32_t);
    pipe.table.texture = pipe.table.travel + 7;
    pipe.travel = {3};
    pipe.points[0] = {1e-3F, 3}, pipe.points[1] = {1e-3F, 1}, pipe.points[2] = {2e-3F, 2};
    floor.texture = {1, {40}, 0};
    floor.relief = {2000, 2};
    floor.levels[0] = {{}, {1e4F, 1e4F}, 60, 1, 0};
    floor.levels[1] = {{}, {5e3F, 5e3F}, 30, 1, 60};
    ball.texture = {2, {}, 0, {{0.6F, 0.8F, 0}, {-0.8F, 0.6F, 0}}, {1e-3F, -2e-3F}};
    ball.relief = {500, 1};
    ball.levels[0] = {{{4, 0, {}}, {4, 7, {}}}, {1e3F, 1e3F}, 9, 9, 0};
    pipe.texture = {3, {300, 500}, 1, {{0, 1, 0}, {0.6F, 0, 0.8F}}};
    WorkloadRandom height{32};
    height.fill(floor.coefficients, 2e-5F / 32768);
    height.fill(ball.coefficients, 3e-4F / 32768);
    raised.table = {{{0, 0, -2500}, {}, {0, 0, 1}, {}}, {{0.8F, 0.6F, 0}, {-0.6F, 0.8F, 0}}, {}, 8e3F};
    raised.relief = {500, 1};
    raised.levels[0] = {{{4, 0, {}}, {4, 7, {}}}, {500, 500}, 9, 9, 0};
    height.fill(raised.coefficients, 2e-3F / 32768);
    // A tetrahedron: a root and two leaves.
    constexpr float kSize_m = 0.015F;
    mesh.table = {{{-1200, -1500, 900}, {}, {0, 0, 1, kSize_m}, {}}, kSize_m * 0x1p-18F, 3, 4, 4};
    const uint32_t skips[3] = {3, 2, 3}, leaves[3] = {0, 0 * 8 + 2, 2 * 8 + 2};
    for (int i = 0; i < 3; ++i) {
      core::MeshNode& node = mesh.nodes[i];
      for (int j = 0; j < 3; ++j) node.least_m[j] = -0.01F * kSize_m, node.most_m[j] = 1.01F * kSize_m;
      node.skip = skips[i], node.leaf = leaves[i];
      mesh.vertices[i + 1][i] = kSize_m;
    }
    const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    for (int i = 0; i < 12; ++i) mesh.triangles[i] = triangles[i];
    block_.header.check = core::scene_check(&block_, sizeof block_);
    core::SceneView view;
    core::read_scene_block(&block_, sizeof block_, view);
    core::ForceSetup setup;
    setup.axes[0] = {core::AxisAlong::x, 1e-5F, 10, 5};
    setup.axes[1] = {core::AxisAlong::y, 1e-5F, 10, 5};
    setup.axes[2] = {core::AxisAlong::z, 1e-5F, 10, 5};
    setup.axis_count = 3;
    setup.peak_n = 10, setup.continuous_n = 5;
    setup.slew_n_per_s = 8000, setup.rate_hz = 1000;
    setup.onset_s = setup.release_s = 0.02F;
    kernel_.set(view, setup, live_);
  }

  /// One tick; the sum of the forces.
  float tick() noexcept {
    for (int i = 0; i < 3; ++i) {
      const int32_t draw = next_();
      if (draw % 100 == 0) speed_[i] = (draw >> 4) % 61;
      if (draw % 333 == 0) speed_[i] = draw % 2;
      if (counts_[i] > 3500) speed_[i] = -speed_[i] < 0 ? -speed_[i] : speed_[i];
      if (counts_[i] < -3500) speed_[i] = -speed_[i] > 0 ? -speed_[i] : speed_[i];
      counts_[i] += speed_[i];
    }
    const auto output = kernel_.tick(counts_, ++ticks_ < kWorkloadTicks - 400);
    flags_ |= output.flags;
    return output.force_n[0] + output.force_n[1] + output.force_n[2];
  }
  uint32_t flags() const noexcept { return flags_; }

 private:
  struct Block {
    core::SceneHeader header;
    core::ScenePatch patch;
    core::SceneLayer layers[kPieces];
    float numbers[kPieces * kWords] = {};
    struct {
      struct {
        core::PieceTable table;
        core::PieceTextureTable texture;
        core::ReliefTable relief;
        core::ReliefLevelTable levels[2];
        float coefficients[90] = {};
      } floor;
      struct {
        core::PieceTable table;
        core::SlideTable slide;
      } plate;
      struct {
        core::PieceTable table;
        core::PieceTextureTable texture;
        core::ReliefTable relief;
        core::ReliefLevelTable levels[1];
        float coefficients[81] = {};
      } ball;
      struct {
        core::PieceTable table;
        core::TravelTable travel;
        core::TravelPoint points[3];
        core::PieceTextureTable texture;
      } pipe;
      core::PieceTable egg;
      struct {
        core::MeshTable table;
        core::MeshNode nodes[3];
        uint32_t triangles[12] = {};
        float vertices[4][3] = {};
      } mesh;
      struct {
        core::ReliefPieceTable table;
        core::ReliefTable relief;
        core::ReliefLevelTable levels[1];
        float coefficients[81] = {};
      } raised;
    } tables;
  } block_;
  WorkloadRandom next_{1996};
  uint32_t flags_ = 0, ticks_ = 0;
  int32_t counts_[3] = {}, speed_[3] = {};
  float live_[kPieces * kWords + core::kPatchWords];
  core::SceneKernel kernel_;
};

}  // namespace tacto::tests

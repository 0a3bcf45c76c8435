// SPDX-License-Identifier: GPL-3.0-or-later
// What a tick costs on a board: the sum of its parts.
#include "playback/choose/board_cost.hpp"

#include <gtest/gtest.h>

namespace tacto::playback {
namespace {

constexpr boards::Board kBoard{"made up", boards::Core::cortex_m4, 100'000'000, 0, 0, 100, 1000, 50'000, 0};
constexpr const boards::TickCosts& kCosts = boards::kTickCosts[0];
constexpr double kCycles = boards::kCyclesPerInstruction;

TEST(BoardCost, IsTheSumOfTheParts) {
  Prepared plain;
  plain.scale.interpolation = wire::Interpolation::sinc;
  const double bare = cost_on(kBoard, plain).tick_cycles;
  EXPECT_EQ(bare, kCycles * (kCosts.around + kCosts.read[3]));
  Prepared full = plain;
  full.taps.resize(33);  // the kernel computes 48
  full.sections.resize(2);
  full.play_operators.count = 5;  // and 8
  EXPECT_EQ(cost_on(kBoard, full).tick_cycles - bare,
            kCycles * (3 * kCosts.sixteen_taps + 2 * kCosts.section + 2 * kCosts.four_plays));
}

TEST(BoardCost, TickAndSendingFitIntoThePeriod) {
  const BoardCost cost = cost_on(kBoard, Prepared{});
  const double cycles = cost.tick_cycles + kCycles * kCosts.poll;
  EXPECT_LE(cost.largest_rate_hz * cycles, kBoard.clock_hz);
  EXPECT_GT((cost.largest_rate_hz + 1) * cycles, kBoard.clock_hz);
  boards::Board slow = kBoard;
  slow.most_rate_hz = 700;
  EXPECT_EQ(cost_on(slow, Prepared{}).largest_rate_hz, 700);
}

// Of two patches that do not add, one acts at a place.
TEST(BoardCost, OfASceneIsThatOfItsDearestPlace) {
  core::ScenePatch patches[3];
  const core::SceneLayer layers[3] = {{0, 0, 0}, {5, 0, 0}, {0, 0, 0}};
  for (std::uint16_t i = 0; i < 3; ++i) patches[i].first_layer = i, patches[i].layers = 1;
  core::SceneView scene;
  scene.patches = patches, scene.layers = layers;
  scene.patch_count = 2, scene.layer_count = 2;
  const auto dearest = [&] { return cost_on(kBoard, scene)->tick_cycles; };
  const double bare = kCycles * (kCosts.around + kCosts.scene + 2 * kCosts.patch);
  EXPECT_EQ(dearest(), bare + kCycles * kCosts.layer[5]);
  scene.patch_count = 3;
  patches[2].adds = 1;
  EXPECT_EQ(dearest(), bare + kCycles * (kCosts.patch + kCosts.layer[5] + kCosts.layer[0]));
}

TEST(BoardCost, CountsHarmonicsAndNotPieces) {
  struct {
    core::GroovesTable table;
    float amplitudes[7] = {};
  } grooves;
  grooves.table.harmonics = 7;
  core::ScenePatch patch;
  patch.layers = 1;
  const core::SceneLayer layer{2, 0, 0};
  core::SceneView scene;
  scene.patches = &patch, scene.layers = &layer;
  scene.tables = reinterpret_cast<const std::uint32_t*>(&grooves);
  scene.patch_count = scene.layer_count = 1;
  EXPECT_EQ(cost_on(kBoard, scene)->tick_cycles,
            kCycles * (kCosts.around + kCosts.scene + kCosts.patch + kCosts.layer[2] + 7 * kCosts.harmonic));
  scene.in_space = true;
  EXPECT_FALSE(cost_on(kBoard, scene));
}

}  // namespace
}  // namespace tacto::playback

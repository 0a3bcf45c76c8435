// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/choose/board_cost.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::playback {
namespace {

using core::SceneLayerKind;

const boards::TickCosts& costs_of(const boards::Board& board) {
  return boards::kTickCosts[static_cast<std::size_t>(board.core)];
}

// The main loop sends in the time that ticks leave.
BoardCost cost_of(const boards::Board& board, double kernel_instructions) {
  const boards::TickCosts& costs = costs_of(board);
  const double tick = boards::kCyclesPerInstruction * (costs.around + kernel_instructions);
  const double sending = boards::kCyclesPerInstruction * costs.poll;
  return {tick, std::min<double>(board.most_rate_hz, std::floor(board.clock_hz / (tick + sending)))};
}

double in_groups(std::size_t count, std::size_t size) {
  const std::size_t groups = (count + size - 1) / size;
  return static_cast<double>(groups);
}

static_assert(boards::kPlaneKinds == static_cast<std::uint32_t>(SceneLayerKind::tick_damper) + 1);

double layer_instructions(const boards::TickCosts& costs, const core::SceneView& scene,
                          const core::SceneLayer& layer) {
  const double own = costs.layer[layer.kind];
  switch (static_cast<SceneLayerKind>(layer.kind)) {
    case SceneLayerKind::grooves:
      return own + costs.harmonic * core::table_of<core::GroovesTable>(scene, layer).harmonics;
    case SceneLayerKind::noise:
      return own + costs.octave * core::table_of<core::NoiseSurfaceTable>(scene, layer).octaves;
    case SceneLayerKind::field:
      return own + costs.atom * core::table_of<core::FieldTable>(scene, layer).atoms;
    default:
      return own;
  }
}

}  // namespace

BoardCost cost_on(const boards::Board& board, const Prepared& texture) {
  const boards::TickCosts& costs = costs_of(board);
  const double plays = in_groups(texture.play_operators.count, 4);
  return cost_of(board, costs.read[static_cast<std::size_t>(texture.scale.interpolation)] +
                            costs.sixteen_taps * in_groups(texture.taps.size(), 16) +
                            static_cast<double>(costs.section * texture.sections.size()) +
                            costs.four_plays * plays);
}

std::optional<BoardCost> cost_on(const boards::Board& board, const core::SceneView& scene) {
  if (scene.in_space) return std::nullopt;
  const boards::TickCosts& costs = costs_of(board);
  double adding = 0, dearest = 0;
  for (std::uint32_t i = 0; i < scene.patch_count; ++i) {
    const core::ScenePatch& patch = scene.patches[i];
    double layers = 0;
    for (std::uint32_t j = 0; j < patch.layers; ++j)
      layers += layer_instructions(costs, scene, scene.layers[patch.first_layer + j]);
    if (patch.adds != 0)
      adding += layers;
    else
      dearest = std::max(dearest, layers);
  }
  return cost_of(board, costs.scene + costs.patch * scene.patch_count + adding + dearest);
}

}  // namespace tacto::playback

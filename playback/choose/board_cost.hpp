// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates what a tick costs on a microcontroller board, from the instruction counts of its parts.
#pragma once

#include <optional>

#include "firmware-host/boards/boards.hpp"
#include "firmware-host/core/scene/scene_block.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// An upper estimate: instructions that QEMU counted (boards::kTickCosts), boards::kCyclesPerInstruction
/// each; nothing of it was measured on a chip.
struct BoardCost {
  double tick_cycles = 0;      ///< of the dearest tick
  double largest_rate_hz = 0;  ///< tick and sending fit in its period, and the board offers it; whole
};

/// Of a texture that may be changed for another one of its kind.
BoardCost cost_on(const boards::Board& board, const Prepared& texture);

/// Of a scene of patches: all patches that add, and the dearest of the others, are under the hand. None for
/// pieces in space, whose contacts the counts do not include.
std::optional<BoardCost> cost_on(const boards::Board& board, const core::SceneView& scene);

}  // namespace tacto::playback

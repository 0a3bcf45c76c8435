// SPDX-License-Identifier: Apache-2.0
// A body that a spring couples to the hand: a brick, and the mass of a lasso.
#pragma once

#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

/// In the axes of its patch, from its centre. The rests are what the sums in single precision lost
/// (Knuth's TwoSum), so that the momentum is the impulse of the force also after minutes.
struct BodyState {
  PlaneVector place_m, place_rest_m, speed_mps, speed_rest_mps;
  float tick = 0;  ///< in which it moved last; 0: never
};
static_assert(sizeof(BodyState) == kBodyStateWords * sizeof(float));

/// Beyond these a body is lost, and begins again at the hand. Without them a spring that is too stiff for the
/// rate would give forces that are not finite.
inline constexpr float kFarthestBody_m = 1e4F, kFastestBody_mps = 1e6F;

bool is_lost(const BodyState& body) noexcept;

/// The force of the coupling on the body: stiffness (hand - place) + damping (speed of the hand - speed).
PlaneVector brick_force(const BodyState& body, const float* number, PlaneVector hand_m,
                        PlaneVector hand_mps) noexcept;

/// The force on the mass of a lasso, towards the hand: stiffness (distance - length), 0 up to the length.
PlaneVector lasso_force(const BodyState& body, const float* number, PlaneVector hand_m) noexcept;

/// One tick with this force, and dry friction on the body's base. Friction is constant over the tick: against
/// what would move the body, as large as stops it at the end of the tick, but at most `static_n` for a body
/// at rest and `kinetic_n` for one that moves. Safe in the tick.
void advance(const BodyTable& table, BodyState& body, PlaneVector force_n, float static_n,
             float kinetic_n) noexcept;

}  // namespace tacto::core

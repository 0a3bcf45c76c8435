// SPDX-License-Identifier: Apache-2.0
// A piece that slides along one axis: a mass with viscous and dry friction, detents and two stops.
#pragma once

#include "firmware-host/core/scene/piece.hpp"

namespace tacto::core {

inline SpaceVector axis_of(const SlideTable& slide) noexcept {
  return {slide.axis[0], slide.axis[1], slide.axis[2]};
}

/// One tick of m v' = push - b v - dry friction - detents: the speed first, with both frictions at the end of
/// the tick (backward Euler), so that friction takes energy at any rate and stops what rests; the place
/// follows by slide_way(). Together semi-implicit: stable with a spring of (K + 2 pi detents_per_m detent_n)
/// T^2 / m < 4 without friction. Against the differential equation: a place within a tick's way. Safe in the
/// tick.
void push_slide(const SlideTable& slide, WallState& state, float push_n) noexcept;

/// The way of this tick along the axis, up to a stop. Safe in the tick.
float slide_way(const SlideTable& slide, const WallState& state, float tick_s) noexcept;

}  // namespace tacto::core

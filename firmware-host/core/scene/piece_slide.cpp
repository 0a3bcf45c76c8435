// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/piece_slide.hpp"

#include "firmware-host/core/scene/lattice_place.hpp"
#include "firmware-host/core/scene/turn.hpp"

namespace tacto::core {

void push_slide(const SlideTable& slide, WallState& state, float push_n) noexcept {
  const auto turns = static_cast<uint32_t>(fixed_point(state.slid_m * slide.detents_per_m));
  const float driven_n = push_n - slide.detent_n * sine_cosine(turns).sine;
  const float speed = slide.kept * (state.slid_mps + slide.speed_by_force_s_per_kg * driven_n),
              stopped = slide.kept * slide.speed_by_force_s_per_kg * slide.friction_n;
  state.slid_mps = speed > stopped ? speed - stopped : speed < -stopped ? speed + stopped : 0;
}

float slide_way(const SlideTable& slide, const WallState& state, float tick_s) noexcept {
  const float way_m = tick_s * state.slid_mps, end_m = state.slid_m + way_m;
  if (end_m > slide.to_m) return slide.to_m - state.slid_m;
  return end_m < slide.from_m ? slide.from_m - state.slid_m : way_m;
}

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/piece_texture.hpp"

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/scene/relief.hpp"

namespace tacto::core {
namespace {

// The frame of GhostPoint::force has to fit a board.
[[gnu::noinline]] SpaceVector recording_force(const PieceTextureTable& texture, float gain, WallState& state,
                                              SpaceVector normal, SpaceVector place_m, SpaceVector speed_mps,
                                              float rate_hz) noexcept {
  const auto along = [&](SpaceVector v) { return v - dot(normal, v) * normal; };
  const SpaceVector way = along(place_m - state.last_m), before = along(state.line);
  const SpaceVector turned = before + (dot(way, before) < 0 ? -1 / kPathLine_m : 1 / kPathLine_m) * way;
  const float size = length(turned);
  if (!(size > 0)) return {};
  const SpaceVector line = state.line = (1 / size) * turned;
  constexpr float kMostPart = 0x1.fffffep30F;
  const float part = dot(way, line) * texture.passes_per_m * 0x1p32F;
  if (within(part, -kMostPart, kMostPart)) state.path += static_cast<uint32_t>(static_cast<int32_t>(part));
  constexpr uint32_t kTurn = UINT32_C(1) << 31;
  const uint32_t from_first = state.path < kTurn ? state.path : ~state.path;
  const ReliefTable& relief = relief_of(texture);
  const float passed_mps = dot(speed_mps, line);
  const PlayedLevels played = played_levels(relief, passed_mps < 0 ? -passed_mps : passed_mps, rate_hz);
  // A level covers half a sample before its first one to half a sample behind its last one.
  const PlaneVector slope = slope_of(relief, played, [&](const ReliefLevelTable& level, int axis) -> Q32 {
    return axis == 0 ? static_cast<Q32>(2 * uint64_t{from_first} * level.columns) - kTurn : 0;
  });
  return (gain * slope.x) * line;
}

}  // namespace

SpaceVector texture_force(const PieceTable& table, const float* number, WallState& state, float normal_n,
                          SpaceVector normal, SpaceVector place_m, SpaceVector speed_mps,
                          float rate_hz) noexcept {
  if (table.texture == 0 || !(normal_n > 0)) return {};
  return recording_force(texture_of(table), number[kPieceTextureGain], state, normal, place_m, speed_mps,
                         rate_hz);
}

}  // namespace tacto::core

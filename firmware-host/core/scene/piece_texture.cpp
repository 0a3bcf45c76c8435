// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/piece_texture.hpp"

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/relief.hpp"
#include "firmware-host/core/scene/turn.hpp"

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
  const float part = dot(way, line) * texture.per_m[0] * 0x1p32F;
  if (within(part, -kMostPart, kMostPart)) state.path += static_cast<uint32_t>(static_cast<int32_t>(part));
  constexpr uint32_t kPass = UINT32_C(1) << 31;
  const uint32_t from_first = state.path < kPass ? state.path : ~state.path;
  const ReliefTable& relief = relief_of(texture);
  const float passed_mps = dot(speed_mps, line);
  const PlayedLevels played = played_levels(relief, passed_mps < 0 ? -passed_mps : passed_mps, rate_hz);
  // A level covers half a sample before its first one to half a sample behind its last one.
  const PlaneVector slope = slope_of(relief, played, [&](const ReliefLevelTable& level, int axis) -> Q32 {
    return axis == 0 ? static_cast<Q32>(2 * uint64_t{from_first} * level.columns) - kPass : 0;
  });
  return (gain * slope.x) * line;
}

SpaceVector axis_of(const PieceTextureTable& texture, int axis) noexcept {
  return {texture.axes[axis][0], texture.axes[axis][1], texture.axes[axis][2]};
}

[[gnu::noinline]] SpaceVector bump_force(const PieceTextureTable& texture, float kappa_n, SpaceVector normal,
                                         SpaceVector place_m, SpaceVector speed_mps, float rate_hz) noexcept {
  const auto along = [&](SpaceVector v) { return v - dot(normal, v) * normal; };
  const SpaceVector axes[2] = {axis_of(texture, 0), axis_of(texture, 1)}, passed_mps = along(speed_mps);
  const float u_mps = dot(axes[0], passed_mps), v_mps = dot(axes[1], passed_mps);
  const ReliefTable& relief = relief_of(texture);
  const PlayedLevels played = played_levels(relief, __builtin_sqrtf(u_mps * u_mps + v_mps * v_mps), rate_hz);
  const PlaneVector slope = slope_of(relief, played, [&](const ReliefLevelTable& level, int axis) -> Q32 {
    return place_from_centre(level, axis, dot(axes[axis], place_m) + texture.origin_m[axis]);
  });
  return -kappa_n * along(slope.x * axes[0] + slope.y * axes[1]);
}

[[gnu::noinline]] float with_sine(const PieceTextureTable& texture, float gain, float normal_n,
                                  SpaceVector normal, SpaceVector place_m, SpaceVector speed_mps,
                                  float rate_hz) noexcept {
  const SpaceVector passed_mps = speed_mps - dot(normal, speed_mps) * normal;
  const float most_n = (gain < 0 ? -gain : gain) * texture.amplitude_n;
  float added_n = gain * texture.amplitude_n, periods_per_s = 0;
  for (int i = 0; i < 2; ++i) {
    const SpaceVector axis = axis_of(texture, i);
    const float at_m = dot(axis, place_m) + texture.origin_m[i], along_mps = dot(axis, passed_mps);
    added_n *= sine_cosine(static_cast<uint32_t>(fixed_point(at_m * texture.per_m[i]))).sine;
    periods_per_s += (along_mps < 0 ? -along_mps : along_mps) * texture.per_m[i];
  }
  added_n *= held_by_rate(periods_per_s / rate_hz);
  const float sum_n = normal_n + (normal_n < most_n ? normal_n / most_n : 1) * added_n;
  return sum_n > 0 ? sum_n : 0;
}

}  // namespace

SpaceVector texture_force(const PieceTable& table, const float* number, WallState& state, float& normal_n,
                          SpaceVector normal, SpaceVector place_m, SpaceVector speed_mps,
                          float rate_hz) noexcept {
  if (table.texture == 0 || !(normal_n > 0)) return {};
  const PieceTextureTable& texture = texture_of(table);
  const float gain = number[kPieceTextureGain];
  if (texture.kind == static_cast<uint32_t>(PieceTextureKind::bump))
    return bump_force(texture, gain * normal_n, normal, place_m, speed_mps, rate_hz);
  if (texture.kind == static_cast<uint32_t>(PieceTextureKind::sine)) {
    normal_n = with_sine(texture, gain, normal_n, normal, place_m, speed_mps, rate_hz);
    return {};
  }
  if (texture.kind == static_cast<uint32_t>(PieceTextureKind::normals)) {
    const SpaceVector tilt = bump_force(texture, gain, normal, place_m, speed_mps, rate_hz);
    normal_n /= __builtin_sqrtf(1 + dot(tilt, tilt));
    return normal_n * tilt;
  }
  return recording_force(texture, gain, state, normal, place_m, speed_mps, rate_hz);
}

}  // namespace tacto::core

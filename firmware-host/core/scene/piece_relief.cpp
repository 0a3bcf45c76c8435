// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/piece_relief.hpp"

#include "firmware-host/core/scene/relief.hpp"

namespace tacto::core {
namespace {

constexpr float kMet_m = 5e-8F;      // over the surface: it is met
constexpr float kArrived_m = 1e-9F;  // a shorter step is none

struct MapFrame {
  SpaceVector normal, u, v;

  explicit MapFrame(const ReliefPieceTable& table) noexcept
      : normal(vector_of(table.piece.form + kPieceDirection)),
        u(vector_of(table.axes[0])),
        v(vector_of(table.axes[1])) {}

  static SpaceVector vector_of(const float* parts) noexcept { return {parts[0], parts[1], parts[2]}; }
};

const ReliefLevelTable& level_of(const ReliefPieceTable& table) noexcept {
  return levels_of(relief_of(table))[0];
}

// The heights of a level, at a place on the map from the origin of the piece.
template <class Sample>
auto sampled(const ReliefPieceTable& table, float u_m, float v_m, Sample sample) noexcept {
  const ReliefLevelTable& level = level_of(table);
  return sample(ReliefLevel{coefficients_of(relief_of(table), level), level.columns, level.rows},
                place_from_centre(level, 0, u_m + table.origin_m[0]),
                place_from_centre(level, 1, v_m + table.origin_m[1]));
}

// Over the surface along the normal of the plane, and how it changes with the place.
struct HeightAbove {
  float height_m;
  SpaceVector slope;
};

HeightAbove height_above(const ReliefPieceTable& table, SpaceVector place) noexcept {
  const MapFrame frame(table);
  const ReliefLevelTable& level = level_of(table);
  const ReliefSample at = sampled(table, dot(frame.u, place), dot(frame.v, place), relief_at);
  return {dot(frame.normal, place) - at.value, frame.normal - (level.samples_per_m[0] * at.by_x) * frame.u -
                                                   (level.samples_per_m[1] * at.by_y) * frame.v};
}

// With the height, its slopes and its second derivatives by u and v.
struct OnMap {
  float u_m, v_m, height_m, by_u, by_v, by_uu, by_uv, by_vv;

  OnMap(const ReliefPieceTable& table, float u, float v) noexcept : u_m(u), v_m(v) {
    const float* const per_m = level_of(table).samples_per_m;
    const CurvedSample at = sampled(table, u, v, curved_relief_at);
    height_m = at.value;
    by_u = per_m[0] * at.by_x, by_v = per_m[1] * at.by_y;
    by_uu = per_m[0] * per_m[0] * at.by_xx, by_uv = per_m[0] * per_m[1] * at.by_xy;
    by_vv = per_m[1] * per_m[1] * at.by_yy;
  }
};

}  // namespace

PieceSurface relief_surface_at(const ReliefPieceTable& table, SpaceVector place) noexcept {
  const HeightAbove at = height_above(table, place);
  const float size = length(at.slope);
  return {at.height_m / size, (1 / size) * at.slope};
}

// A height c that changes by b, and by at most `bend` in its second derivative, stays above 0 up to the root
// of c + b s - bend s^2 / 2.
float relief_entry(const ReliefPieceTable& table, SpaceVector place, SpaceVector way,
                   float under_m) noexcept {
  constexpr float kFree = 2;
  const MapFrame frame(table);
  const float u_m = dot(frame.u, way), v_m = dot(frame.v, way),
              bend = table.bend_per_m * (u_m * u_m + v_m * v_m);
  float part = 0;
  for (int i = 0; i < kReliefEntrySteps && part <= 1; ++i) {
    const HeightAbove at = height_above(table, place + part * way);
    const float c = at.height_m + under_m, b = dot(at.slope, way);
    if (i == 0 && c < 0) return under_m > 0 ? kFree : 0;
    if (i > 0 && c <= kMet_m) return part;
    const float root = __builtin_sqrtf(b * b + 2 * bend * c), below = b > 0 ? bend : root - b,
                above = b > 0 ? root + b : 2 * c;
    if (!(above < kFree * below)) return kFree;
    part += above / below;
  }
  return part;
}

float relief_bend(const ReliefPieceTable& table, SpaceVector place, SpaceVector way) noexcept {
  const MapFrame frame(table);
  const OnMap at(table, dot(frame.u, place), dot(frame.v, place));
  const float u_m = dot(frame.u, way), v_m = dot(frame.v, way);
  const float bend = at.by_uu * u_m * u_m + 2 * at.by_uv * u_m * v_m + at.by_vv * v_m * v_m;
  return bend > 0 ? bend / __builtin_sqrtf(1 + at.by_u * at.by_u + at.by_v * at.by_v) : 0;
}

SpaceVector slid_on_relief(const ReliefPieceTable& table, SpaceVector hand, SpaceVector start) noexcept {
  constexpr float kRounding = 1 + 1e-6F;  // of a squared distance
  const MapFrame frame(table);
  const float hand_u_m = dot(frame.u, hand), hand_v_m = dot(frame.v, hand),
              hand_height_m = dot(frame.normal, hand);
  const ReliefLevelTable& level = level_of(table);
  const float per_m =
      level.samples_per_m[0] > level.samples_per_m[1] ? level.samples_per_m[0] : level.samples_per_m[1];
  const auto squared_from_hand = [&](const OnMap& at) {
    const float u = at.u_m - hand_u_m, v = at.v_m - hand_v_m, w = at.height_m - hand_height_m;
    return u * u + v * v + w * w;
  };
  OnMap at(table, dot(frame.u, start), dot(frame.v, start));
  float squared = squared_from_hand(at), step_u = 0, step_v = 0;
  bool moved = true;
  for (int i = 0; i < kSlideSteps; ++i) {
    if (moved) {
      const float depth_m = at.height_m - hand_height_m;
      const float by_u = at.u_m - hand_u_m + depth_m * at.by_u, by_v = at.v_m - hand_v_m + depth_m * at.by_v;
      const float a = 1 + at.by_u * at.by_u + depth_m * at.by_uu, b = at.by_u * at.by_v + depth_m * at.by_uv,
                  c = 1 + at.by_v * at.by_v + depth_m * at.by_vv, size = a * c - b * b;
      if (a > 0 && size > 0) {
        step_u = (b * by_v - c * by_u) / size, step_v = (b * by_u - a * by_v) / size;
      } else {
        const float deep_m = depth_m < 0 ? -depth_m : depth_m;
        const float steepest = 1 + at.by_u * at.by_u + at.by_v * at.by_v + deep_m * table.bend_per_m;
        step_u = -by_u / steepest, step_v = -by_v / steepest;
      }
      const float samples = per_m * __builtin_sqrtf(step_u * step_u + step_v * step_v);
      if (samples > 1) step_u /= samples, step_v /= samples;
    }
    if (!(step_u * step_u + step_v * step_v > kArrived_m * kArrived_m)) break;
    const OnMap next(table, at.u_m + step_u, at.v_m + step_v);
    const float next_squared = squared_from_hand(next);
    moved = next_squared <= kRounding * squared;
    if (moved)
      at = next, squared = next_squared;
    else
      step_u *= 0.25F, step_v *= 0.25F;
  }
  return at.u_m * frame.u + at.v_m * frame.v + at.height_m * frame.normal;
}

}  // namespace tacto::core

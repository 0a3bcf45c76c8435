// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/piece.hpp"

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/scene/piece_relief.hpp"

namespace tacto::core {
namespace {

// Of which piece.cpp has no surface.
bool is_elsewhere(SceneLayerKind kind) noexcept {
  return kind == SceneLayerKind::mesh || kind == SceneLayerKind::volume;
}

constexpr float kNoEntry = 2;
constexpr float kNoExit = 1e30F;
constexpr float kLeastArm = 1e-3F;  // of the radius: nearer to a centre the direction is one of rounding

SpaceVector direction_of(const PieceTable& table) noexcept {
  return {table.form[kPieceDirection], table.form[kPieceDirection + 1], table.form[kPieceDirection + 2]};
}

// From the axis of a cylinder, or the centre of a sphere.
SpaceVector arm_of(SceneLayerKind kind, const PieceTable& table, SpaceVector place) noexcept {
  if (kind == SceneLayerKind::sphere) return place;
  const SpaceVector axis = direction_of(table);
  return place - dot(axis, place) * axis;
}

// The terms of the second order, times v; the sum of all terms; half its gradient.
SpaceVector second_order(const float* q, SpaceVector v) noexcept {
  return {q[0] * v.x + 0.5F * (q[3] * v.y + q[5] * v.z), q[1] * v.y + 0.5F * (q[3] * v.x + q[4] * v.z),
          q[2] * v.z + 0.5F * (q[5] * v.x + q[4] * v.y)};
}

SpaceVector first_order(const float* q) noexcept {
  return {q[6], q[7], q[8]};
}

float value_of(const float* q, SpaceVector p) noexcept {
  return dot(second_order(q, p) + first_order(q), p) + q[9];
}

SpaceVector gradient_of(const float* q, SpaceVector p) noexcept {
  return 2 * second_order(q, p) + first_order(q);
}

// The first root of c + 2 b s + a s^2 from above, for c >= 0.
float first_root(float a, float b, float c) noexcept {
  const float square = b * b - a * c;
  if (!(square >= 0)) return kNoEntry;
  const float below = __builtin_sqrtf(square) - b;
  return below > 0 && c < kNoEntry * below ? c / below : kNoEntry;
}

struct Symmetric {
  float xx, yy, zz, xy, yz, xz;
};

// The adjugate times v.
SpaceVector adjugate_times(const Symmetric& m, SpaceVector v) noexcept {
  const float xx = m.yy * m.zz - m.yz * m.yz, yy = m.xx * m.zz - m.xz * m.xz, zz = m.xx * m.yy - m.xy * m.xy;
  const float xy = m.xz * m.yz - m.xy * m.zz, xz = m.xy * m.yz - m.xz * m.yy, yz = m.xy * m.xz - m.xx * m.yz;
  return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
}

float determinant(const Symmetric& m) noexcept {
  return m.xx * (m.yy * m.zz - m.yz * m.yz) - m.xy * (m.xy * m.zz - m.xz * m.yz) +
         m.xz * (m.xy * m.yz - m.xz * m.yy);
}

// A step with lambda and p together: (1 + 2 lambda A) dp + grad q dlambda = -(p - hand + lambda grad q),
// grad q dp = -q.
bool nearest_on_quadric(const float* q, SpaceVector hand, SpaceVector start, SpaceVector& nearest) noexcept {
  SpaceVector p = start;
  SpaceVector slope = gradient_of(q, p);
  float lambda = dot(hand - p, slope) / dot(slope, slope);
  for (int i = 0; i < kQuadricSteps; ++i) {
    const Symmetric m{1 + 2 * lambda * q[0], 1 + 2 * lambda * q[1], 1 + 2 * lambda * q[2],
                      lambda * q[3],         lambda * q[4],         lambda * q[5]};
    const float size = determinant(m);
    const SpaceVector rest = (hand - p) - lambda * slope;
    const SpaceVector by_rest = adjugate_times(m, rest), by_slope = adjugate_times(m, slope);
    const float step = (dot(slope, by_rest) + size * value_of(q, p)) / dot(slope, by_slope);
    p = p + (1 / size) * (by_rest - step * by_slope);
    lambda += step;
    slope = gradient_of(q, p);
  }
  nearest = p;
  // Along the normal, on the surface: within a ten-thousandth of the way.
  const float squared = dot(slope, slope), value = value_of(q, p);
  const SpaceVector way = hand - p, beside = way - (dot(way, slope) / squared) * slope;
  constexpr float kLeast_m = 1e-8F, kShare = 1e-4F;
  const float bound = kLeast_m + kShare * length(way);
  return is_finite(dot(p, p)) && value * value <= bound * bound * squared &&
         dot(beside, beside) <= bound * bound;
}

// The first root of c + 2 b s + a s^2 from below, for c < 0.
float exit_root(float a, float b, float c) noexcept {
  const float square = b * b - a * c;
  if (!(square >= 0)) return kNoExit;
  const float root = __builtin_sqrtf(square);
  if (b >= 0) return root + b > 0 ? -c / (root + b) : kNoExit;
  return a > 0 ? (root - b) / a : kNoExit;
}

// The nearest of the places that it is given.
struct NearestFace {
  SpaceVector hand;
  SpaceVector place;
  float squared_m2 = kNoExit;

  void try_place(SpaceVector p) noexcept {
    const SpaceVector way = p - hand;
    const float squared = dot(way, way);
    if (squared < squared_m2) squared_m2 = squared, place = p;
  }
  // The way out of the solid from a place in it.
  void try_way(const float* q, SpaceVector from, SpaceVector way) noexcept {
    const float a = dot(second_order(q, way), way), b = 0.5F * dot(gradient_of(q, from), way);
    const float part = exit_root(a, b, value_of(q, from));
    if (part < kNoExit) try_place(from + part * way);
  }
};

// p with (1 + 2 lambda A) p = hand - lambda b, if the matrix is positive definite.
bool place_of(const float* q, SpaceVector hand, float lambda, SpaceVector& p) noexcept {
  const Symmetric m{1 + 2 * lambda * q[0], 1 + 2 * lambda * q[1], 1 + 2 * lambda * q[2],
                    lambda * q[3],         lambda * q[4],         lambda * q[5]};
  const float size = determinant(m);
  if (!(m.xx > 0) || !(m.xx * m.yy - m.xy * m.xy > 0) || !(size > 0)) return false;
  p = (1 / size) * adjugate_times(m, hand - lambda * first_order(q));
  return is_finite(dot(p, p));
}

}  // namespace

PieceSurface surface_at(SceneLayerKind kind, const PieceTable& table, SpaceVector place) noexcept {
  if (is_elsewhere(kind)) return {kNoExit, {}};
  if (kind == SceneLayerKind::relief) return relief_surface_at(relief_piece(table), place);
  if (kind == SceneLayerKind::plane) {
    const SpaceVector normal = direction_of(table);
    const float above_m = dot(normal, place), thickness_m = table.form[kPieceSize];
    if (thickness_m > 0 && above_m < -0.5F * thickness_m) return {-thickness_m - above_m, -1 * normal};
    return {above_m, normal};
  }
  if (kind == SceneLayerKind::quadric) {
    const float* const q = table.form;
    const SpaceVector slope = gradient_of(q, place);
    const float size = length(slope), value = value_of(q, place);
    if (!(size > 1e-6F)) return {value, {}};
    return {value / size, (1 / size) * slope};
  }
  const SpaceVector arm = arm_of(kind, table, place);
  const float radius_m = length(arm);
  if (!(radius_m > 0)) return {-table.form[kPieceSize], direction_of(table)};
  return {radius_m - table.form[kPieceSize], (1 / radius_m) * arm};
}

float entry_of(SceneLayerKind kind, const PieceTable& table, SpaceVector place, SpaceVector way) noexcept {
  if (is_elsewhere(kind)) return kNoEntry;
  if (kind == SceneLayerKind::relief) return relief_entry(relief_piece(table), place, way, 0);
  if (kind == SceneLayerKind::plane) {
    const SpaceVector normal = direction_of(table);
    const float above_m = dot(normal, place), rise_m = dot(normal, way), thickness_m = table.form[kPieceSize];
    if (above_m >= 0) return above_m + rise_m < 0 ? above_m / -rise_m : kNoEntry;
    const float below_m = -thickness_m - above_m;
    if (!(thickness_m > 0) || below_m < 0) return 0;
    return rise_m > below_m ? below_m / rise_m : kNoEntry;
  }
  float a, b, c;
  if (kind == SceneLayerKind::quadric) {
    const float* const q = table.form;
    a = dot(second_order(q, way), way);
    b = 0.5F * dot(gradient_of(q, place), way);
    c = value_of(q, place);
  } else {
    const SpaceVector arm = arm_of(kind, table, place), turn = arm_of(kind, table, way);
    const float radius_m = table.form[kPieceSize];
    a = dot(turn, turn);
    b = dot(arm, turn);
    c = dot(arm, arm) - radius_m * radius_m;
  }
  return c < 0 ? 0 : first_root(a, b, c);
}

// The height over the surface is at most b^2 / -a / |grad q|.
float return_to(const PieceTable& quadric, SpaceVector place, SpaceVector way, float height_m) noexcept {
  const float* const q = quadric.form;
  const SpaceVector slope = gradient_of(q, place);
  const float a = dot(second_order(q, way), way), b = 0.5F * dot(slope, way), c = value_of(q, place);
  if (!(a < 0) || !(b > 0) || !(b * b > -a * height_m * length(slope))) return kNoEntry;
  const float square = b * b - a * c;
  if (!(square >= 0)) return kNoEntry;
  const float end = b + __builtin_sqrtf(square);
  return end < kNoEntry * -a ? end / -a : kNoEntry;
}

float bend_of(const PieceTable& quadric, SpaceVector place, SpaceVector way) noexcept {
  const float* const q = quadric.form;
  const float bend = -2 * dot(second_order(q, way), way);
  return bend > 0 ? bend / length(gradient_of(q, place)) : 0;
}

bool nearest_on(SceneLayerKind kind, const PieceTable& table, SpaceVector hand, SpaceVector start,
                SpaceVector& nearest) noexcept {
  if (kind == SceneLayerKind::relief) return false;
  if (kind == SceneLayerKind::quadric) return nearest_on_quadric(table.form, hand, start, nearest);
  if (kind == SceneLayerKind::plane) {
    const PieceSurface at = surface_at(kind, table, start);
    const SpaceVector normal = at.normal;
    nearest = hand - (dot(normal, hand - start) + at.distance_m) * normal;
    return true;
  }
  const SpaceVector arm = arm_of(kind, table, hand);
  const float radius_m = length(arm);
  if (!(radius_m > kLeastArm * table.form[kPieceSize])) return false;
  nearest = hand + ((table.form[kPieceSize] - radius_m) / radius_m) * arm;
  return true;
}

// While 1 + 2 lambda A is positive definite, q(p(lambda)) falls with lambda: so its root is one, and it is
// the nearest place of all (the condition of a trust region). In a centre, or on an axis, there is no root:
// the last p is then in the solid, and the surface is as near on both sides along the direction that becomes
// singular.
bool nearest_face(const PieceTable& quadric, SpaceVector hand, SpaceVector& nearest) noexcept {
  constexpr int kDoublings = 32, kHalvings = 24;
  const float* const q = quadric.form;
  const SpaceVector axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  NearestFace face{hand, hand};
  for (const SpaceVector& axis : axes) {
    face.try_way(q, hand, axis);
    face.try_way(q, hand, -1 * axis);
  }
  const SpaceVector slope = gradient_of(q, hand);
  const float start = -value_of(q, hand) / dot(slope, slope);
  float in = 0, out = start < kNoExit ? start : 1;
  SpaceVector inside = hand, p;
  for (int i = 0; i < kDoublings; ++i, in = out, inside = p, out *= 2)
    if (!place_of(q, hand, -out, p) || !(value_of(q, p) < 0)) break;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5F * (in + out);
    if (place_of(q, hand, -middle, p) && value_of(q, p) < 0)
      in = middle, inside = p;
    else
      out = middle;
  }
  face.try_way(q, inside, gradient_of(q, inside));
  const Symmetric m{1 - 2 * in * q[0], 1 - 2 * in * q[1], 1 - 2 * in * q[2],
                    -in * q[3],        -in * q[4],        -in * q[5]};
  for (const SpaceVector& axis : axes) {
    const SpaceVector column = adjugate_times(m, axis);
    const float size = length(column);
    if (!(size > 0)) continue;
    const SpaceVector singular = (1 / size) * column;
    face.try_way(q, inside, singular);
    face.try_way(q, inside, -1 * singular);
  }
  if (!(face.squared_m2 < kNoExit)) return false;
  // Rounding does not tell places near the nearest one apart by their distance, but by the normal.
  constexpr float kAsNear = 1 + 1e-5F;
  nearest = face.place;
  if (nearest_on_quadric(q, hand, face.place, p) && dot(p - hand, p - hand) <= kAsNear * face.squared_m2)
    nearest = p;
  return true;
}

float spring_force(const PieceTable& table, float stiffness, float depth_m) noexcept {
  if (table.travel == 0) return stiffness * depth_m;
  const TravelTable& travel = travel_of(table);
  TravelPoint last;
  for (uint32_t i = 0; i < travel.points; ++i) {
    const TravelPoint& next = points_of(travel)[i];
    if (depth_m < next.depth_m)
      return last.force_n +
             (next.force_n - last.force_n) * ((depth_m - last.depth_m) / (next.depth_m - last.depth_m));
    last = next;
  }
  return last.force_n + stiffness * (depth_m - last.depth_m);
}

float wall_force(const float* number, const PieceTable& table, WallState& state,
                 const WallTouch& touch) noexcept {
  if (!(touch.depth_m > 0) && touch.outside_m > kLetGo_m)
    state = {0, 0, 0, 0, 0, {}, {}, state.line, state.path, state.slid_m, state.slid_mps};
  const TransientTable& transient = table.transient;
  const float s = state.transient_n, c = state.turning_n, *const step = transient.step;
  const bool ended = s * s + c * c < kTransientEnd_n * kTransientEnd_n;
  state.transient_n = ended ? 0 : s + (step[0] * s + step[1] * c);
  state.turning_n = ended ? 0 : c + (step[2] * s + step[3] * c);
  if (!(touch.depth_m > 0)) return 0;
  const float inwards_mps = touch.speed_mps < 0 ? -touch.speed_mps : 0;
  if (state.touched == 0) {
    state.impulse_ns = number[kPieceArrestMass] * inwards_mps;
    state.transient_n = transient.start_n_s_per_m[0] * inwards_mps;
    state.turning_n = transient.start_n_s_per_m[1] * inwards_mps;
  }
  state.touched = 1;
  if (inwards_mps == 0) state.impulse_ns = 0;
  const float deep_m = touch.depth_m > kIntegralRest * touch.grain_m ? touch.depth_m : 0,
              grown_n = state.integral_n + touch.tick_s * (number[kPieceIntegral] * deep_m -
                                                           number[kPieceIntegralLeak] * state.integral_n),
              bound_n = number[kPieceIntegralBound];
  state.integral_n = grown_n < 0 ? 0 : grown_n > bound_n ? bound_n : grown_n;
  float force_n = spring_force(table, number[kPieceStiffness], touch.depth_m) -
                  number[kPieceDamping] * touch.speed_mps + state.integral_n + state.transient_n;
  force_n = force_n > 0 ? force_n : 0;
  const float asked_n = state.impulse_ns / touch.tick_s, left_n = touch.most_force_n - force_n;
  const float given_n = asked_n < left_n ? asked_n : left_n;
  if (!(given_n > 0)) return force_n;
  state.impulse_ns -= given_n * touch.tick_s;
  return force_n + given_n;
}

SpaceVector friction_force(const float* number, WallState& state, float normal_n, SpaceVector normal,
                           SpaceVector place_m, SpaceVector speed_mps) noexcept {
  const auto along = [&](SpaceVector v) { return v - dot(normal, v) * normal; };
  const float stiffness = number[kPieceStiffness],
              per_coefficient_m = stiffness > 0 ? normal_n / stiffness : 0,
              holds_m = number[kPieceStaticFriction] * per_coefficient_m,
              slipped_m = number[kPieceKineticFriction] * per_coefficient_m;
  const SpaceVector last_m = state.last_m;
  state.last_m = place_m;
  const SpaceVector viscous_n = normal_n > 0 ? -number[kPieceViscous] * along(speed_mps) : SpaceVector{};
  if (!(holds_m > 0)) {
    state.anchor_m = place_m;
    return viscous_n;
  }
  const SpaceVector held = along(place_m - state.anchor_m);
  const float most = holds_m * holds_m;
  if (dot(held, held) <= most) return viscous_n - stiffness * held;
  SpaceVector stretch = along(last_m - state.anchor_m), way = along(place_m - last_m);
  const auto shorten_to = [&](float to_m) {
    const float size = length(stretch);
    if (size > to_m) stretch = (to_m / size) * stretch;
  };
  if (dot(stretch, stretch) > most) shorten_to(slipped_m);  // the force along the normal fell
  for (int i = 0; i < kMostSlips; ++i) {
    const SpaceVector end = stretch + way;
    if (!(dot(end, end) > most)) break;
    const float a = dot(way, way), b = dot(stretch, way), c = dot(stretch, stretch) - most,
                root = __builtin_sqrtf(b * b - a * c), part = b > 0 ? -c / (root + b) : (root - b) / a;
    if (!(part > 0 && part < 1)) break;
    stretch = stretch + part * way;
    way = (1 - part) * way;
    shorten_to(slipped_m);
  }
  stretch = stretch + way;
  if (dot(stretch, stretch) > most) {
    const float slip_m = holds_m - slipped_m, slips = (length(stretch) - slipped_m) / slip_m;
    const float rest = within(slips, 0, 1e6F) ? slips - static_cast<float>(static_cast<int32_t>(slips)) : 0;
    shorten_to(slipped_m + rest * slip_m);
  }
  state.anchor_m = place_m - stretch;
  return viscous_n - stiffness * stretch;
}

}  // namespace tacto::core

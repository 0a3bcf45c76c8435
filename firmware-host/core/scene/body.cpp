// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/body.hpp"

#include "firmware-host/core/kernel/finite.hpp"

namespace tacto::core {
namespace {

// sum + rest += value, without a loss but that of the rest.
void add(float& sum, float& rest, float value) noexcept {
  const float part = value + rest, total = sum + part, added = total - sum;
  rest = (sum - (total - added)) + (part - added);
  sum = total;
}

float length(PlaneVector v) noexcept {
  return __builtin_sqrtf(v.x * v.x + v.y * v.y);
}

PlaneVector to_hand(const BodyState& body, PlaneVector hand_m) noexcept {
  return {(hand_m.x - body.place_m.x) - body.place_rest_m.x,
          (hand_m.y - body.place_m.y) - body.place_rest_m.y};
}

}  // namespace

bool is_lost(const BodyState& body) noexcept {
  return !within(body.place_m.x, -kFarthestBody_m, kFarthestBody_m) ||
         !within(body.place_m.y, -kFarthestBody_m, kFarthestBody_m) ||
         !within(body.speed_mps.x, -kFastestBody_mps, kFastestBody_mps) ||
         !within(body.speed_mps.y, -kFastestBody_mps, kFastestBody_mps);
}

PlaneVector brick_force(const BodyState& body, const float* number, PlaneVector hand_m,
                        PlaneVector hand_mps) noexcept {
  const PlaneVector way = to_hand(body, hand_m);
  const float stiffness = number[kBodyStiffness], damping = number[kBodyDamping];
  return {stiffness * way.x + damping * (hand_mps.x - body.speed_mps.x),
          stiffness * way.y + damping * (hand_mps.y - body.speed_mps.y)};
}

PlaneVector lasso_force(const BodyState& body, const float* number, PlaneVector hand_m) noexcept {
  const PlaneVector way = to_hand(body, hand_m);
  const float distance = length(way), slack = number[kLassoLength];
  if (!(distance > slack)) return {};
  const float force_per_m = number[kLassoStiffness] * ((distance - slack) / distance);
  return {force_per_m * way.x, force_per_m * way.y};
}

void advance(const BodyTable& table, BodyState& body, PlaneVector force_n, float static_n,
             float kinetic_n) noexcept {
  const float by_force = table.speed_by_force_s_per_kg;
  const PlaneVector v = body.speed_mps;
  const PlaneVector stop_n{-((v.x + table.speed_loss * v.x) / by_force + force_n.x),
                           -((v.y + table.speed_loss * v.y) / by_force + force_n.y)};
  const bool rests = v.x == 0 && v.y == 0;
  const float needed_n = length(stop_n), most_n = rests ? static_n : kinetic_n;
  const bool stops = needed_n <= most_n;
  if (rests && stops) return;
  const float share = stops ? 1 : most_n / needed_n;
  const auto along = [&](float n, float& place, float& place_rest, float& speed, float& speed_rest) {
    add(place, place_rest,
        table.place_by_speed_s * speed + table.place_by_speed_s * speed_rest +
            table.place_by_force_s2_per_kg * n);
    add(speed, speed_rest, table.speed_loss * speed + by_force * n);
    if (stops) speed = speed_rest = 0;
  };
  along(force_n.x + share * stop_n.x, body.place_m.x, body.place_rest_m.x, body.speed_mps.x,
        body.speed_rest_mps.x);
  along(force_n.y + share * stop_n.y, body.place_m.y, body.place_rest_m.y, body.speed_mps.y,
        body.speed_rest_mps.y);
}

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/scene_kernel.hpp"

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/scene/body.hpp"
#include "firmware-host/core/scene/field.hpp"
#include "firmware-host/core/scene/grooves.hpp"

namespace tacto::core {

void SceneKernel::set(const SceneView& scene, const ForceSetup& setup, float* live) noexcept {
  scene_ = scene;
  live_ = live;
  moved_ = reinterpret_cast<int32_t(*)[2]>(live + scene.number_count);
  order_ = reinterpret_cast<uint32_t*>(moved_ + scene.patch_count);
  for (uint32_t i = 0; i < scene.number_count; ++i) live[i] = scene.numbers[i];
  for (uint32_t i = 0; i < scene.patch_count; ++i) {
    moved_[i][0] = moved_[i][1] = 0;
    order_[i] = i;
  }
  if (scene.tables_change)
    __builtin_memcpy(live + scene.words_before_tables(), scene.tables, scene.table_words * sizeof(uint32_t));
  for (Ramp& ramp : ramps_) ramp.left = 0;
  for (Move& move : moves_) move.left = 0;
  next_ramp_ = next_move_ = 0;
  moving_ = has_last_counts_ = false;
  tick_ = last_tick_ = 1;
  setup_ = setup;
  for (float& step_m : step_m_) step_m = 0;
  for (uint32_t i = 0; i < setup.axis_count; ++i)
    step_m_[static_cast<uint32_t>(setup.axes[i].along)] = setup.axes[i].metres_per_count;
  for (uint32_t i = 0; i < 2; ++i)
    if (step_m_[i] == 0) step_m_[i] = step_m_[1 - i];
  if (step_m_[2] == 0) step_m_[2] = step_m_[0];
  ghost_.rest();
  for (EdgeSpeed& speed : speeds_) speed.rest();
  envelope_.set(setup.onset_s * setup.rate_hz, setup.release_s * setup.rate_hz);
  limiter_.set(setup);
}

void SceneKernel::change(uint32_t layer, uint32_t number, float value, float ramp_ticks) noexcept {
  const uint32_t at = scene_.layers[layer].first_number + number;
  uint32_t place = kMostRamps;
  for (uint32_t i = 0; i < kMostRamps; ++i)
    if (ramps_[i].left > 0 && ramps_[i].number == at) place = i;
  if (place == kMostRamps) {
    place = next_ramp_;
    next_ramp_ = (next_ramp_ + 1) % kMostRamps;
    if (ramps_[place].left > 0) live_[ramps_[place].number] = ramps_[place].to;
  }
  const auto ticks = ramp_ticks > 1 ? static_cast<uint32_t>(ramp_ticks) : UINT32_C(1);
  ramps_[place] = {at, ticks, (value - live_[at]) / static_cast<float>(ticks), value};
}

void SceneKernel::advance_ramps() noexcept {
  for (Ramp& ramp : ramps_) {
    if (ramp.left == 0) continue;
    --ramp.left;
    live_[ramp.number] = ramp.left == 0 ? ramp.to : live_[ramp.number] + ramp.step;
  }
}

// As Bresenham's line: without a division in the tick.
int32_t SceneKernel::Way::step(uint32_t ticks) noexcept {
  sum += rest;
  if (sum < ticks) return each;
  sum -= ticks;
  return each + more;
}

void SceneKernel::move(uint32_t patch, const int32_t (&counts)[2], float ramp_ticks) noexcept {
  uint32_t place = kMostRamps;
  for (uint32_t i = 0; i < kMostRamps; ++i)
    if (moves_[i].left > 0 && moves_[i].patch == patch) place = i;
  if (place == kMostRamps) {
    place = next_move_;
    next_move_ = (next_move_ + 1) % kMostRamps;
    const Move& oldest = moves_[place];
    if (oldest.left > 0)
      for (int i = 0; i < 2; ++i) moved_[oldest.patch][i] = oldest.ways[i].to;
  }
  const auto ticks = ramp_ticks > 1 ? static_cast<uint32_t>(ramp_ticks) : UINT32_C(1);
  Move& move = moves_[place];
  move.patch = patch, move.left = move.ticks = ticks;
  for (int i = 0; i < 2; ++i) {
    const int32_t way = counts[i] - moved_[patch][i], of = static_cast<int32_t>(ticks), rest = way % of;
    move.ways[i] = {counts[i],
                    way / of,
                    way < 0 ? -1 : 1,
                    static_cast<uint32_t>(rest < 0 ? -rest : rest),
                    0,
                    static_cast<float>(way) / static_cast<float>(of)};
  }
  moving_ = true;
}

void SceneKernel::raise(uint32_t patch) noexcept {
  uint32_t at = 0;
  while (at + 1 < scene_.patch_count && order_[at] != patch) ++at;
  for (; at > 0; --at) order_[at] = order_[at - 1];
  order_[0] = patch;
}

void SceneKernel::advance_moves() noexcept {
  if (!moving_) return;
  moving_ = false;
  for (Move& move : moves_) {
    if (move.left == 0) continue;
    moving_ = true;
    --move.left;
    for (int i = 0; i < 2; ++i) moved_[move.patch][i] += move.ways[i].step(move.ticks);
  }
}

// During the tick after the last step it is at rest.
PlaneVector SceneKernel::speed_of(uint32_t patch) const noexcept {
  for (const Move& move : moves_)
    if (move.left > 0 && move.patch == patch)
      return {move.ways[0].per_tick * (step_m_[0] * setup_.rate_hz),
              move.ways[1].per_tick * (step_m_[1] * setup_.rate_hz)};
  return {};
}

SceneKernel::Hand SceneKernel::hand_on(uint32_t patch, const Hand& hand) const noexcept {
  Hand here = hand;
  for (int i = 0; i < 2; ++i)
    here.counts[i] =
        static_cast<int32_t>(static_cast<uint32_t>(hand.counts[i]) - static_cast<uint32_t>(moved_[patch][i]));
  const PlaneVector in_plane{static_cast<float>(here.counts[0]) * step_m_[0],
                             static_cast<float>(here.counts[1]) * step_m_[1]};
  here.place_m = place_in_patch(scene_.patches[patch], in_plane);
  if (!moving_) return here;
  const PlaneVector own = speed_of(patch);
  here.along_mps = {hand.speed_mps.x - own.x, hand.speed_mps.y - own.y};
  return here;
}

// Here and below in the axes of the patch.
PlaneVector SceneKernel::groove_force(const SceneLayer& layer, const Hand& hand,
                                      PlaneVector along) const noexcept {
  const auto& table = table_of<GroovesTable>(scene_, layer);
  const float* const number = live_ + layer.first_number;
  const float across = along.x * table.periods_per_m_x + along.y * table.periods_per_m_y;
  const auto phase = static_cast<uint32_t>(place_on(table.across, hand.counts));
  const GrooveSample at = groove_at({amplitudes_of(table), table.harmonics}, phase,
                                    (across < 0 ? -across : across) / setup_.rate_hz);
  const float force = -(number[kSurfaceKappa] * number[kSurfaceDepth]) * at.by_phase;
  return {force * table.periods_per_m_x, force * table.periods_per_m_y};
}

PlaneVector SceneKernel::noise_force(const SceneLayer& layer, const Hand& hand) const noexcept {
  const auto& table = table_of<NoiseSurfaceTable>(scene_, layer);
  const float* const number = live_ + layer.first_number;
  const PlaneVector v = hand.along_mps;
  float cycles_per_tick =
      __builtin_sqrtf(v.x * v.x + v.y * v.y) * table.periods_per_m * kNoiseCycles / setup_.rate_hz;
  float weights[kMostOctaves];
  for (uint32_t i = 0; i < table.octaves; ++i, cycles_per_tick *= 2)
    weights[i] = amplitudes_of(table)[i] * held_by_rate(cycles_per_tick);
  const NoiseSample at = fractal_noise(table.gradients, place_on(table.along[0], hand.counts),
                                       place_on(table.along[1], hand.counts), 0, weights, table.octaves);
  const float force = -(number[kSurfaceKappa] * number[kSurfaceDepth]) * table.periods_per_m;
  return {force * at.by_x, force * at.by_y};
}

// A map of one row varies along it only.
PlayedLevels SceneKernel::levels_at(const ReliefTable& table, const Hand& hand,
                                    PlaneVector along) const noexcept {
  const PlaneVector v = hand.along_mps;
  const float along_row = along.x * table.cosine + along.y * table.sine;
  const float speed = levels_of(table)->rows > 1 ? __builtin_sqrtf(v.x * v.x + v.y * v.y)
                      : along_row < 0            ? -along_row
                                                 : along_row;
  return played_levels(table, speed, setup_.rate_hz);
}

PlaneVector SceneKernel::relief_force(const SceneLayer& layer, const Hand& hand,
                                      PlaneVector along) const noexcept {
  const auto& table = table_of<ReliefTable>(scene_, layer);
  const PlaneVector slope = slope_of(
      table, levels_at(table, hand, along),
      [&](const ReliefLevelTable& level, int axis) { return place_on(level.along[axis], hand.counts); });
  const float kappa = live_[layer.first_number + kHeightMapKappa];
  return {-kappa * (table.cosine * slope.x - table.sine * slope.y),
          -kappa * (table.sine * slope.x + table.cosine * slope.y)};
}

// A map of one angle: that of its patch.
PlaneVector SceneKernel::map_force(const SceneLayer& layer, const Hand& hand,
                                   PlaneVector along) const noexcept {
  const auto& table = table_of<ReliefTable>(scene_, layer);
  const uint32_t last = table.levels - 1, along_rows = coefficient_count(table);
  auto [first, weights] = levels_at(table, hand, along);
  if (first >= last) first = last, weights[0] = 1, weights[1] = 0;
  PlaneVector force;
  for (uint32_t i = 0; i < 2; ++i) {
    if (weights[i] == 0) continue;
    const ReliefLevelTable& level = levels_of(table)[first + i];
    float values[2];
    values_at({coefficients_of(table, level), level.columns, level.rows}, along_rows,
              place_on(level.along[0], hand.counts), place_on(level.along[1], hand.counts), values);
    force.x += weights[i] * values[0];
    force.y += weights[i] * values[1];
  }
  const float gain = live_[layer.first_number + kForceMapGain];
  return {gain * force.x, gain * force.y};
}

PlaneVector SceneKernel::body_force(const SceneLayer& layer, const Hand& hand, PlaneVector along) noexcept {
  const auto kind = static_cast<SceneLayerKind>(layer.kind);
  float* const number = live_ + layer.first_number;
  auto& body = *reinterpret_cast<BodyState*>(number + changeable_numbers_of(kind));
  if (body.tick != last_tick_ || is_lost(body)) body = {hand.place_m, {}, {}, {}, 0};
  body.tick = tick_;
  const bool brick = kind == SceneLayerKind::body;
  const PlaneVector force_n =
      brick ? brick_force(body, number, hand.place_m, along) : lasso_force(body, number, hand.place_m);
  advance(table_of<BodyTable>(scene_, layer), body, force_n, brick ? number[kBodyStaticFriction] : 0,
          brick ? number[kBodyKineticFriction] : 0);
  return {-force_n.x, -force_n.y};
}

bool SceneKernel::body_place(uint32_t patch, uint32_t layer, PlaneVector& place_m) const noexcept {
  if (patch >= scene_.patch_count) return false;
  const ScenePatch& on = scene_.patches[patch];
  if (layer < on.first_layer || layer >= uint32_t{on.first_layer} + on.layers) return false;
  const auto kind = static_cast<SceneLayerKind>(scene_.layers[layer].kind);
  if (!has_body(kind)) return false;
  const auto& body = *reinterpret_cast<const BodyState*>(live_ + scene_.layers[layer].first_number +
                                                         changeable_numbers_of(kind));
  if (body.tick != tick_) return false;
  const PlaneVector at = body.place_m;
  place_m = {
      on.centre_x_m + static_cast<float>(moved_[patch][0]) * step_m_[0] + on.cosine * at.x - on.sine * at.y,
      on.centre_y_m + static_cast<float>(moved_[patch][1]) * step_m_[1] + on.sine * at.x + on.cosine * at.y};
  return true;
}

// Units of length are 2^-32 periods: the lower half of a place, whose upper half is 0 in the patch.
PlaneVector SceneKernel::field_force(const SceneLayer& layer, const Hand& hand) const noexcept {
  const auto& table = table_of<FieldTable>(scene_, layer);
  const float* const number = live_ + layer.first_number;
  int32_t units[2];
  for (int i = 0; i < 2; ++i) units[i] = static_cast<int32_t>(place_on(table.along[i], hand.counts));
  const FieldForce at = core::field_force(atoms_of(table), table.atoms, table.core, units[0], units[1],
                                          number[kFieldZ] * table.units_per_m);
  return {number[kFieldScale] * at.x, number[kFieldScale] * at.y};
}

PlaneVector SceneKernel::force_in(const ScenePatch& patch, const Hand& hand) noexcept {
  const PlaneVector place = hand.place_m, speed = into_patch(patch, hand.speed_mps),
                    along = into_patch(patch, hand.along_mps);
  PlaneVector sum;
  for (uint32_t i = 0; i < patch.layers; ++i) {
    const SceneLayer& layer = scene_.layers[patch.first_layer + i];
    const float* const number = live_ + layer.first_number;
    PlaneVector force;
    switch (static_cast<SceneLayerKind>(layer.kind)) {
      case SceneLayerKind::spring:
        force = {-number[kSpringStiffness] * (place.x - number[kSpringCentreX]),
                 -number[kSpringStiffness] * (place.y - number[kSpringCentreY])};
        break;
      case SceneLayerKind::damper:
        force = {-number[kDamperDamping] * speed.x, -number[kDamperDamping] * speed.y};
        break;
      case SceneLayerKind::tick_damper: {
        const PlaneVector of_tick = into_patch(patch, hand.tick_speed_mps);
        force = {-number[kDamperDamping] * of_tick.x, -number[kDamperDamping] * of_tick.y};
        break;
      }
      case SceneLayerKind::grooves:
        force = groove_force(layer, hand, along);
        break;
      case SceneLayerKind::noise:
        force = noise_force(layer, hand);
        break;
      case SceneLayerKind::height_map:
        force = relief_force(layer, hand, along);
        break;
      case SceneLayerKind::force_map:
        force = map_force(layer, hand, along);
        break;
      case SceneLayerKind::body:
      case SceneLayerKind::lasso:
        force = body_force(layer, hand, along);
        break;
      case SceneLayerKind::mover: {
        const auto& table = table_of<MoverTable>(scene_, layer);
        const float own_mps = number[kMoverSpeed];
        force = {number[kMoverDamping] * (own_mps * table.cosine - speed.x),
                 number[kMoverDamping] * (own_mps * table.sine - speed.y)};
        break;
      }
      case SceneLayerKind::field:
        force = field_force(layer, hand);
        break;
      case SceneLayerKind::plane:
      case SceneLayerKind::sphere:
      case SceneLayerKind::cylinder:
      case SceneLayerKind::quadric:
      case SceneLayerKind::mesh:
      case SceneLayerKind::relief:
      case SceneLayerKind::volume:
        break;  // in space: GhostPoint
    }
    sum.x += force.x;
    sum.y += force.y;
  }
  return sum;
}

PlaneVector SceneKernel::force(const Hand& hand) noexcept {
  PlaneVector sum;
  bool covered = false;
  for (uint32_t i = 0; i < scene_.patch_count; ++i) {
    const ScenePatch& patch = scene_.patches[order_[i]];
    const bool adds = patch.adds != 0;
    if (covered && !adds) continue;
    const Hand here = hand_on(order_[i], hand);
    if (!within_patch(patch, here.place_m)) continue;
    covered = covered || !adds;
    const PlaneVector local = force_in(patch, here);
    sum.x += patch.cosine * local.x - patch.sine * local.y;
    sum.y += patch.sine * local.x + patch.cosine * local.y;
  }
  return sum;
}

SpaceVector SceneKernel::force_in_plane(const int32_t* counts) noexcept {
  Hand hand;
  float speed_mps[2] = {}, tick_speed_mps[2] = {};
  for (uint32_t i = 0; i < setup_.axis_count; ++i) {
    const auto along = static_cast<uint32_t>(setup_.axes[i].along);
    if (along > 1) continue;
    hand.counts[along] = counts[i];
    const float mps_per_count = step_m_[along] * setup_.rate_hz;
    if (has_last_counts_)
      tick_speed_mps[along] =
          static_cast<float>(static_cast<int32_t>(static_cast<uint32_t>(counts[i]) -
                                                  static_cast<uint32_t>(last_counts_[along]))) *
          mps_per_count;
    last_counts_[along] = counts[i];
    if (scene_.needs_speed) speed_mps[along] = speeds_[along].track(counts[i]) * mps_per_count;
  }
  has_last_counts_ = true;
  hand.speed_mps = hand.along_mps = {speed_mps[0], speed_mps[1]};
  hand.tick_speed_mps = {tick_speed_mps[0], tick_speed_mps[1]};
  const PlaneVector sum = force(hand);
  return {sum.x, sum.y, 0};
}

SpaceVector SceneKernel::force_in_space(const int32_t* counts) noexcept {
  SpaceHand hand;
  float speed_mps[3] = {};
  for (uint32_t i = 0; i < setup_.axis_count; ++i) {
    const auto along = static_cast<uint32_t>(setup_.axes[i].along);
    hand.counts[along] = counts[i];
    speed_mps[along] = speeds_[along].track(counts[i]) * (step_m_[along] * setup_.rate_hz);
  }
  hand.speed_mps = {speed_mps[0], speed_mps[1], speed_mps[2]};
  return ghost_.force(scene_, live_, hand, step_m_, setup_);
}

ForceOutput SceneKernel::tick(const int32_t* counts, bool raise) noexcept {
  advance_ramps();
  advance_moves();
  last_tick_ = tick_;
  tick_ = tick_ < 0x1p24F ? tick_ + 1 : 2;
  const SpaceVector sum = scene_.in_space ? force_in_space(counts) : force_in_plane(counts);
  ForceOutput output;
  output.sound = is_finite(sum.x) && is_finite(sum.y) && is_finite(sum.z);
  const float weight = envelope_.step(raise && output.sound);
  const float along[3] = {sum.x, sum.y, sum.z};
  for (uint32_t i = 0; i < setup_.axis_count && output.sound; ++i)
    output.force_n[i] = output.unlimited_n[i] = weight * along[static_cast<uint32_t>(setup_.axes[i].along)];
  limiter_.limit(output.force_n, output.flags);
  return output;
}

}  // namespace tacto::core

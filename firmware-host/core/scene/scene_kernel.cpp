// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/scene_kernel.hpp"

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/kernel/level_of_detail.hpp"
#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/relief.hpp"

namespace tacto::core {

void SceneKernel::set(const SceneView& scene, const ForceSetup& setup, float* live) noexcept {
  scene_ = scene;
  live_ = live;
  for (uint32_t i = 0; i < scene.number_count; ++i) live[i] = scene.numbers[i];
  for (Ramp& ramp : ramps_) ramp.left = 0;
  next_ramp_ = 0;
  setup_ = setup;
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

// Here and below in the axes of the patch.
PlaneVector SceneKernel::groove_force(const SceneLayer& layer, const Hand& hand,
                                      PlaneVector speed) const noexcept {
  const auto& table = table_of<GroovesTable>(scene_, layer);
  const float* const number = live_ + layer.first_number;
  const float across = speed.x * table.periods_per_m_x + speed.y * table.periods_per_m_y;
  const auto phase = static_cast<uint32_t>(place_on(table.across, hand.counts));
  const GrooveSample at = groove_at({amplitudes_of(table), table.harmonics}, phase,
                                    (across < 0 ? -across : across) / setup_.rate_hz);
  const float force = -(number[kSurfaceKappa] * number[kSurfaceDepth]) * at.by_phase;
  return {force * table.periods_per_m_x, force * table.periods_per_m_y};
}

PlaneVector SceneKernel::noise_force(const SceneLayer& layer, const Hand& hand) const noexcept {
  const auto& table = table_of<NoiseSurfaceTable>(scene_, layer);
  const float* const number = live_ + layer.first_number;
  const PlaneVector v = hand.speed_mps;
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

// A level is left when its highest frequency reaches half the rate.
PlaneVector SceneKernel::relief_force(const SceneLayer& layer, const Hand& hand) const noexcept {
  const auto& table = table_of<ReliefTable>(scene_, layer);
  const PlaneVector v = hand.speed_mps;
  const float cycles_per_tick = __builtin_sqrtf(v.x * v.x + v.y * v.y) * table.highest_per_m / setup_.rate_hz;
  const Detail detail = detail_at(cycles_per_tick * (1 / kWholeReliefPerTick));
  const float weights[2] = {1 - detail.fade, detail.fade};
  PlaneVector slope;
  for (uint32_t i = 0; i < 2; ++i) {
    if (weights[i] == 0 || detail.coarser + i >= table.levels) continue;
    const ReliefLevelTable& level = levels_of(table)[detail.coarser + i];
    const ReliefSample at =
        relief_at({coefficients_of(table, level), level.columns, level.rows},
                  place_on(level.along[0], hand.counts), place_on(level.along[1], hand.counts));
    slope.x += weights[i] * level.samples_per_m[0] * at.by_x;
    slope.y += weights[i] * level.samples_per_m[1] * at.by_y;
  }
  const float kappa = live_[layer.first_number + kHeightMapKappa];
  return {-kappa * slope.x, -kappa * slope.y};
}

PlaneVector SceneKernel::force_in(const ScenePatch& patch, const Hand& hand,
                                  PlaneVector place) const noexcept {
  const PlaneVector speed = into_patch(patch, hand.speed_mps);
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
      case SceneLayerKind::grooves:
        force = groove_force(layer, hand, speed);
        break;
      case SceneLayerKind::noise:
        force = noise_force(layer, hand);
        break;
      case SceneLayerKind::height_map:
        force = relief_force(layer, hand);
        break;
    }
    sum.x += force.x;
    sum.y += force.y;
  }
  return sum;
}

PlaneVector SceneKernel::force(const Hand& hand) const noexcept {
  PlaneVector sum;
  bool covered = false;
  for (uint32_t i = 0; i < scene_.patch_count; ++i) {
    const ScenePatch& patch = scene_.patches[i];
    const bool adds = patch.adds != 0;
    if (covered && !adds) continue;
    const PlaneVector here = place_in_patch(patch, hand.place_m);
    if (!within_patch(patch, here)) continue;
    covered = covered || !adds;
    const PlaneVector local = force_in(patch, hand, here);
    sum.x += patch.cosine * local.x - patch.sine * local.y;
    sum.y += patch.sine * local.x + patch.cosine * local.y;
  }
  return sum;
}

ForceOutput SceneKernel::tick(const int32_t* counts, bool raise) noexcept {
  advance_ramps();
  Hand hand;
  float place_m[2] = {}, speed_mps[2] = {};
  for (uint32_t i = 0; i < setup_.axis_count; ++i) {
    const auto along = static_cast<uint32_t>(setup_.axes[i].along);
    if (along > 1) continue;
    const float step_m = setup_.axes[i].metres_per_count;
    hand.counts[along] = counts[i];
    place_m[along] = static_cast<float>(counts[i]) * step_m;
    if (!scene_.needs_speed) continue;
    speed_mps[along] = speeds_[along].track(counts[i]) * (step_m * setup_.rate_hz);
  }
  hand.place_m = {place_m[0], place_m[1]};
  hand.speed_mps = {speed_mps[0], speed_mps[1]};
  const PlaneVector sum = force(hand);
  ForceOutput output;
  output.sound = is_finite(sum.x) && is_finite(sum.y);
  const float weight = envelope_.step(raise && output.sound);
  for (uint32_t i = 0; i < setup_.axis_count && output.sound; ++i) {
    const AxisAlong along = setup_.axes[i].along;
    if (along != AxisAlong::z) output.unlimited_n[i] = weight * (along == AxisAlong::x ? sum.x : sum.y);
    output.force_n[i] = output.unlimited_n[i];
  }
  limiter_.limit(output.force_n, output.flags);
  return output;
}

}  // namespace tacto::core

// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/scene_block.hpp"

#include <stddef.h>

#include "firmware-host/core/kernel/finite.hpp"
#include "firmware-host/core/wire/crc32c.hpp"

namespace tacto::core {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the block is read in place");

// As in the schema of scenes, so that sums of forces stay far below the largest float.
constexpr float kFarthest_m = 10, kStiffest_n_per_m = 1e6F, kMostDamping_n_s_per_m = 1e4F;
constexpr float kFarthestPatch_m = 1e3F;
constexpr float kUnitRounding = 1e-5F;  // rounding of cosine^2 + sine^2

bool sound(const ScenePatch& patch) noexcept {
  const float square = patch.cosine * patch.cosine + patch.sine * patch.sine;
  return within(patch.centre_x_m, -kFarthestPatch_m, kFarthestPatch_m) &&
         within(patch.centre_y_m, -kFarthestPatch_m, kFarthestPatch_m) &&
         within(square, 1 - kUnitRounding, 1 + kUnitRounding) &&
         within(patch.half_width_m, 0, kFarthestPatch_m) &&
         within(patch.half_height_m, 0, kFarthestPatch_m) && patch.adds <= 1;
}

bool sound(SceneLayerKind kind, const float* number) noexcept {
  if (kind == SceneLayerKind::damper) return within(number[kDamperDamping], 0, kMostDamping_n_s_per_m);
  return within(number[kSpringStiffness], 0, kStiffest_n_per_m) &&
         within(number[kSpringCentreX], -kFarthest_m, kFarthest_m) &&
         within(number[kSpringCentreY], -kFarthest_m, kFarthest_m);
}

// Patches and layers use all layers and numbers, one after the other: none is shared or left over.
SceneFault check_patches(const SceneView& view) noexcept {
  uint32_t layers = 0;
  for (uint32_t i = 0; i < view.patch_count; ++i) {
    const ScenePatch& patch = view.patches[i];
    if (patch.first_layer != layers || patch.layers == 0) return SceneFault::structure;
    layers += patch.layers;
    if (!sound(patch)) return SceneFault::value;
  }
  return layers == view.layer_count ? SceneFault::none : SceneFault::structure;
}

SceneFault check_layers(SceneView& view) noexcept {
  uint32_t numbers = 0;
  for (uint32_t i = 0; i < view.layer_count; ++i) {
    const SceneLayer& layer = view.layers[i];
    if (layer.first_number != numbers || layer.kind >= kSceneLayerKinds) return SceneFault::structure;
    const auto kind = static_cast<SceneLayerKind>(layer.kind);
    numbers += numbers_of(kind);
    if (numbers > view.number_count) return SceneFault::structure;
    if (!sound(kind, view.numbers + layer.first_number)) return SceneFault::value;
    view.needs_speed = view.needs_speed || kind == SceneLayerKind::damper;
  }
  return numbers == view.number_count ? SceneFault::none : SceneFault::structure;
}

}  // namespace

bool number_fits(const SceneView& view, uint32_t layer, uint32_t number, float value) noexcept {
  if (layer >= view.layer_count) return false;
  const auto kind = static_cast<SceneLayerKind>(view.layers[layer].kind);
  const uint32_t count = numbers_of(kind);
  if (number >= count) return false;
  float numbers[kMostLayerNumbers];
  for (uint32_t i = 0; i < count; ++i) numbers[i] = view.numbers[view.layers[layer].first_number + i];
  numbers[number] = value;
  return sound(kind, numbers);
}

uint32_t scene_check(const void* block, uint32_t bytes) noexcept {
  const auto* const at = static_cast<const uint8_t*>(block);
  const uint32_t before = wire::crc32c(at, offsetof(SceneHeader, check));
  return wire::crc32c(at + sizeof(SceneHeader), bytes - sizeof(SceneHeader), before);
}

SceneFault read_scene_block(const void* block, uint32_t bytes, SceneView& view) noexcept {
  SceneHeader header;
  if (bytes < sizeof header) return SceneFault::size;
  __builtin_memcpy(&header, block, sizeof header);
  if (header.mark != kSceneMark) return SceneFault::mark;
  if (header.version != kSceneVersion) return SceneFault::version;
  const uint32_t patches = header.patches * uint32_t{sizeof(ScenePatch)},
                 layers = header.layers * uint32_t{sizeof(SceneLayer)},
                 numbers = header.numbers * uint32_t{sizeof(float)};
  if (bytes != sizeof header + patches + layers + numbers) return SceneFault::size;
  if (header.check != scene_check(block, bytes)) return SceneFault::check;
  if (header.layers > kMostSceneLayers || header.patches > header.layers) return SceneFault::structure;
  const auto* const at = static_cast<const uint8_t*>(block) + sizeof header;
  SceneView read{reinterpret_cast<const ScenePatch*>(at),
                 reinterpret_cast<const SceneLayer*>(at + patches),
                 reinterpret_cast<const float*>(at + patches + layers),
                 header.patches,
                 header.layers,
                 header.numbers,
                 false};
  if (const SceneFault fault = check_patches(read); fault != SceneFault::none) return fault;
  if (const SceneFault fault = check_layers(read); fault != SceneFault::none) return fault;
  view = read;
  return SceneFault::none;
}

}  // namespace tacto::core

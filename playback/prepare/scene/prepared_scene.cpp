// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/prepared_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

namespace tacto::playback {

using core::SceneLayerKind;
using schema::ErrorKind;
using schema::fail;
using schema::ForceLayer;
using schema::Result;

namespace {

struct LayerData {
  SceneLayerKind kind;
  std::vector<float> numbers;
};

// Named one by one: a new kind of layer does not compile until it is here or has data.
template <class L>
concept NotPlayedYet = std::same_as<L, schema::HeightMapLayer> || std::same_as<L, schema::GroovesLayer> ||
                       std::same_as<L, schema::NoiseLayer> || std::same_as<L, schema::TextureForceLayer> ||
                       std::same_as<L, schema::MassLayer> || std::same_as<L, schema::BodyLayer> ||
                       std::same_as<L, schema::LassoLayer> || std::same_as<L, schema::MoverLayer> ||
                       std::same_as<L, schema::ForceMapLayer> || std::same_as<L, schema::FieldLayer>;

float single(const schema::LayerNumber& number) {
  return static_cast<float>(number.value);
}

using MaybeData = std::optional<LayerData>;

MaybeData data_of(const ForceLayer& layer) {
  return layer.visit(
      [](const schema::SpringLayer& spring) -> MaybeData {
        return LayerData{
            SceneLayerKind::spring,
            {single(spring.stiffness_n_per_m), single(spring.centre_x_m), single(spring.centre_y_m)}};
      },
      [](const schema::DamperLayer& damper) -> MaybeData {
        return LayerData{SceneLayerKind::damper, {single(damper.damping_n_s_per_m)}};
      },
      [](const NotPlayedYet auto& /*layer*/) -> MaybeData { return std::nullopt; });
}

Result<void> check_types(const schema::Scene& scene, const std::string& where) {
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    for (std::size_t j = 0; j < scene.patches[i].layers.size(); ++j)
      if (const ForceLayer& layer = scene.patches[i].layers[j]; !data_of(layer))
        return fail(ErrorKind::unsuitable,
                    fmt::format("layers of the type {} cannot be played yet", type_of(layer)),
                    fmt::format("{}#/patches/{}/layers/{}/type", where, i, j),
                    "the types that can be played are spring and damper");
  return {};
}

core::ScenePatch patch_data(const schema::Patch& patch) {
  const double angle_rad = patch.angle_deg * std::numbers::pi / 180;
  core::ScenePatch data;
  data.centre_x_m = static_cast<float>(patch.x_m);
  data.centre_y_m = static_cast<float>(patch.y_m);
  data.cosine = static_cast<float>(std::cos(angle_rad));
  data.sine = static_cast<float>(std::sin(angle_rad));
  data.half_width_m = static_cast<float>(patch.width_m / 2);
  data.half_height_m = static_cast<float>(patch.height_m / 2);
  data.adds = patch.combine == schema::PatchCombine::add ? 1 : 0;
  return data;
}

template <class T>
void append(std::vector<std::uint32_t>& words, const std::vector<T>& parts) {
  static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
  const std::size_t before = words.size();
  words.resize(before + parts.size() * sizeof(T) / sizeof(std::uint32_t));
  if (!parts.empty()) std::memcpy(words.data() + before, parts.data(), parts.size() * sizeof(T));
}

std::vector<std::uint32_t> block_of(const std::vector<schema::Patch>& from) {
  std::vector<core::ScenePatch> patches;
  std::vector<core::SceneLayer> layers;
  std::vector<float> numbers;
  for (const schema::Patch& patch : from) {
    patches.push_back(patch_data(patch));
    patches.back().first_layer = static_cast<std::uint16_t>(layers.size());
    patches.back().layers = static_cast<std::uint16_t>(patch.layers.size());
    for (const ForceLayer& layer : patch.layers) {
      const LayerData data = *data_of(layer);
      layers.push_back({static_cast<std::uint16_t>(data.kind), static_cast<std::uint16_t>(numbers.size())});
      numbers.insert(numbers.end(), data.numbers.begin(), data.numbers.end());
    }
  }
  core::SceneHeader header;
  header.patches = static_cast<std::uint16_t>(patches.size());
  header.layers = static_cast<std::uint16_t>(layers.size());
  header.numbers = static_cast<std::uint16_t>(numbers.size());
  std::vector<std::uint32_t> words;
  append(words, std::vector{header});
  append(words, patches);
  append(words, layers);
  append(words, numbers);
  header.check =
      core::scene_check(words.data(), static_cast<std::uint32_t>(words.size() * sizeof(std::uint32_t)));
  std::memcpy(words.data(), &header, sizeof header);
  return words;
}

}  // namespace

core::SceneView PreparedScene::view() const {
  core::SceneView view;
  core::read_scene_block(words.data(), static_cast<std::uint32_t>(bytes()), view);
  return view;
}

std::vector<std::string_view> numbers_in_block(const ForceLayer& layer) {
  std::vector<std::string_view> names;
  if (!data_of(layer)) return names;
  for (const auto& [name, number] : numbers_of(layer)) names.push_back(name);
  return names;
}

std::size_t layer_bytes(const ForceLayer& layer) {
  const MaybeData data = data_of(layer);
  return data ? sizeof(core::SceneLayer) + data->numbers.size() * sizeof(float) : 0;
}

Result<PreparedScene> prepare_scene(const schema::Scene& scene, const std::string& where) {
  if (scene.patches.empty())
    return fail(ErrorKind::unsuitable, "this scene has no force patches", where,
                "a scene of a tray is played with --transducer");
  TACTO_TRY(check_types(scene, where));
  PreparedScene prepared{{scene.patches.rbegin(), scene.patches.rend()}, {}};
  std::ranges::stable_sort(prepared.patches, std::ranges::greater(), &schema::Patch::order);
  prepared.words = block_of(prepared.patches);
  return prepared;
}

}  // namespace tacto::playback

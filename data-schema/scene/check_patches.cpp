// SPDX-License-Identifier: GPL-3.0-or-later
// What the schema cannot check of patches.
#include <fmt/format.h>

#include <concepts>
#include <unordered_set>

#include "data-schema/scene/scene.hpp"

namespace tacto::schema {
namespace {

template <class L, class... Kinds>
concept AnyOf = (std::same_as<L, Kinds> || ...);

// Named one by one: a new kind does not compile until it is here or has a rule.
template <class L>
concept NoFurtherRule = AnyOf<L, HeightMapLayer, GroovesLayer, NoiseLayer, TextureForceLayer, SpringLayer,
                              DamperLayer, MoverLayer, ForceMapLayer, FieldLayer>;

// A mass that moves by itself has an acceleration: force / mass.
Result<void> check_own_mass(const LayerNumber& mass_kg, const std::string& where) {
  const double least_kg = least_value(mass_kg);
  if (least_kg > 0) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("mass_kg is {:g}: a body and a lasso need a mass above 0", least_kg),
              where + "/mass_kg", "give it a mass");
}

Result<void> check_body(const BodyLayer& body, const std::string& where) {
  TACTO_TRY(check_own_mass(body.mass_kg, where));
  const double kinetic_n = largest_value(body.kinetic_friction_n),
               static_n = least_value(body.static_friction_n);
  if (kinetic_n <= static_n) return {};
  const bool by_slider = body.kinetic_friction_n.slider || body.static_friction_n.slider;
  return fail(
      ErrorKind::unsuitable,
      by_slider
          ? fmt::format("kinetic_friction_n can become {:g}, and static_friction_n {:g}", kinetic_n, static_n)
          : fmt::format("kinetic_friction_n is {:g}, above the static_friction_n of {:g}", kinetic_n,
                        static_n),
      where + "/kinetic_friction_n",
      by_slider
          ? "let the slider of the kinetic friction end at most where that of the static friction begins"
          : "at most the static friction");
}

Result<void> check_force_layer(const ForceLayer& layer, const std::string& where) {
  for (const NamedLayerNumber& number : numbers_of(layer)) TACTO_TRY(check_slider(number, where));
  return layer.visit([&](const BodyLayer& body) { return check_body(body, where); },
                     [&](const LassoLayer& lasso) { return check_own_mass(lasso.mass_kg, where); },
                     [](const NoFurtherRule auto& /*other*/) { return Result<void>(); });
}

Result<void> check_patch_names(const Scene& scene, const std::string& where) {
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    if (!names.insert(scene.patches[i].name).second)
      return fail(ErrorKind::unsuitable, fmt::format("two patches are named '{}'", scene.patches[i].name),
                  fmt::format("{}#/patches/{}/name", where, i), "give each patch its own name");
  return {};
}

Result<void> check_layer_count(const Scene& scene, const std::string& where) {
  std::size_t layers = scene.layers.size();
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    layers += scene.patches[i].layers.size();
    if (layers > kMostLayers)
      return fail(ErrorKind::unsuitable, fmt::format("the scene has more than {} layers", kMostLayers),
                  fmt::format("{}#/patches/{}", where, i), "make two scenes of it");
  }
  return {};
}

}  // namespace

Result<void> check_slider(const NamedLayerNumber& named, const std::string& where) {
  const LayerNumber& number = named.number;
  if (!number.slider) return {};
  if (!named.changes)
    return fail(ErrorKind::unsuitable,
                fmt::format("{} has a slider, but it cannot change while the scene plays", named.name),
                fmt::format("{}/{}/slider", where, named.name), "give its value alone, as a number");
  const auto& [from, to] = *number.slider;
  if (!(from < to))
    return fail(ErrorKind::unsuitable,
                fmt::format("the slider of {} is from {:g} to {:g}", named.name, from, to),
                fmt::format("{}/{}/slider", where, named.name), "give the lower end first");
  if (number.value >= from && number.value <= to) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("{} is {:g}, outside its slider from {:g} to {:g}", named.name, number.value, from, to),
      fmt::format("{}/{}/value", where, named.name), "choose a value in the range of the slider");
}

Result<void> check_patches(const Scene& scene, const std::string& where) {
  TACTO_TRY(check_layer_count(scene, where));
  TACTO_TRY(check_patch_names(scene, where));
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    for (std::size_t j = 0; j < scene.patches[i].layers.size(); ++j)
      TACTO_TRY(check_force_layer(scene.patches[i].layers[j],
                                  fmt::format("{}#/patches/{}/layers/{}", where, i, j)));
  return {};
}

Result<void> check_only_plane(const Scene& scene, const std::string& where) {
  if (scene.pieces.empty()) return {};
  return fail(ErrorKind::unsuitable, "this command does not know pieces in space yet", where + "#/pieces",
              "play, render, explain, replay, design and info do; name a scene with patches here");
}

Result<void> check_only_tray(const Scene& scene, const std::string& where) {
  if (!scene.pieces.empty())
    return fail(ErrorKind::unsuitable, "this scene has pieces in space, which a tray cannot play",
                where + "#/pieces",
                "name a force device: `render` and `explain` have --device, `play` has -d "
                "sim:arm");
  if (scene.patches.empty()) return {};
  return fail(ErrorKind::unsuitable, "this scene has force patches, which a tray cannot play",
              where + "#/patches",
              "name a force device: `render`, `explain` and `trade` have --device, `play` has -d sim:planar; "
              "for a tray "
              "use a scene that has only layers");
}

}  // namespace tacto::schema

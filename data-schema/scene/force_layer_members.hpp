// SPDX-License-Identifier: GPL-3.0-or-later
// The names of the members of each kind of force layer: the one table for reading, writing and listing them.
// Internal to this folder.
#pragma once

#include <string_view>

#include "data-schema/scene/force_layer.hpp"

namespace tacto::schema {

template <class L>
struct LayerMember {
  std::string_view name;
  LayerNumber L::*number;
  bool changes = true;  ///< may have a slider: it can change while the scene plays
  bool whole = false;   ///< a whole number
};

inline constexpr bool kFixed = false, kWhole = true;

/// Its type in the file, and its numbers (but filter_m of grooves, which may be a word).
template <class L>
struct LayerMembers;

template <>
struct LayerMembers<HeightMapLayer> {
  static constexpr std::string_view kType = "height_map";
  static constexpr LayerMember<HeightMapLayer> kNumbers[] = {{"kappa_n", &HeightMapLayer::kappa_n}};
};

template <>
struct LayerMembers<GroovesLayer> {
  static constexpr std::string_view kType = "grooves";
  static constexpr LayerMember<GroovesLayer> kNumbers[] = {
      {"period_m", &GroovesLayer::period_m, kFixed},
      {"depth_m", &GroovesLayer::depth_m},
      {"kappa_n", &GroovesLayer::kappa_n},
      {"direction_deg", &GroovesLayer::direction_deg, kFixed},
      {"filter_margin", &GroovesLayer::filter_margin, kFixed}};
};

template <>
struct LayerMembers<NoiseLayer> {
  static constexpr std::string_view kType = "noise";
  static constexpr LayerMember<NoiseLayer> kNumbers[] = {{"period_m", &NoiseLayer::period_m, kFixed},
                                                         {"octaves", &NoiseLayer::octaves, kFixed, kWhole},
                                                         {"roughness", &NoiseLayer::roughness, kFixed},
                                                         {"seed", &NoiseLayer::seed, kFixed, kWhole},
                                                         {"depth_m", &NoiseLayer::depth_m},
                                                         {"kappa_n", &NoiseLayer::kappa_n}};
};

template <>
struct LayerMembers<TextureForceLayer> {
  static constexpr std::string_view kType = "texture";
  static constexpr LayerMember<TextureForceLayer> kNumbers[] = {
      {"direction_deg", &TextureForceLayer::direction_deg, kFixed}, {"gain", &TextureForceLayer::gain}};
};

template <>
struct LayerMembers<SpringLayer> {
  static constexpr std::string_view kType = "spring";
  static constexpr LayerMember<SpringLayer> kNumbers[] = {
      {"stiffness_n_per_m", &SpringLayer::stiffness_n_per_m},
      {"centre_x_m", &SpringLayer::centre_x_m},
      {"centre_y_m", &SpringLayer::centre_y_m}};
};

template <>
struct LayerMembers<DamperLayer> {
  static constexpr std::string_view kType = "damper";
  static constexpr LayerMember<DamperLayer> kNumbers[] = {
      {"damping_n_s_per_m", &DamperLayer::damping_n_s_per_m}};
};

template <>
struct LayerMembers<BodyLayer> {
  static constexpr std::string_view kType = "body";
  static constexpr LayerMember<BodyLayer> kNumbers[] = {
      {"mass_kg", &BodyLayer::mass_kg, kFixed},
      {"stiffness_n_per_m", &BodyLayer::stiffness_n_per_m},
      {"damping_n_s_per_m", &BodyLayer::damping_n_s_per_m},
      {"static_friction_n", &BodyLayer::static_friction_n},
      {"kinetic_friction_n", &BodyLayer::kinetic_friction_n}};
};

template <>
struct LayerMembers<LassoLayer> {
  static constexpr std::string_view kType = "lasso";
  static constexpr LayerMember<LassoLayer> kNumbers[] = {
      {"mass_kg", &LassoLayer::mass_kg, kFixed},
      {"stiffness_n_per_m", &LassoLayer::stiffness_n_per_m},
      {"length_m", &LassoLayer::length_m},
      {"damping_n_s_per_m", &LassoLayer::damping_n_s_per_m, kFixed}};
};

template <>
struct LayerMembers<MoverLayer> {
  static constexpr std::string_view kType = "mover";
  static constexpr LayerMember<MoverLayer> kNumbers[] = {
      {"speed_mps", &MoverLayer::speed_mps},
      {"damping_n_s_per_m", &MoverLayer::damping_n_s_per_m},
      {"direction_deg", &MoverLayer::direction_deg, kFixed}};
};

template <>
struct LayerMembers<ForceMapLayer> {
  static constexpr std::string_view kType = "force_map";
  static constexpr LayerMember<ForceMapLayer> kNumbers[] = {{"gain", &ForceMapLayer::gain}};
};

template <>
struct LayerMembers<FieldLayer> {
  static constexpr std::string_view kType = "field";
  static constexpr LayerMember<FieldLayer> kNumbers[] = {
      {"length_scale", &FieldLayer::length_scale, kFixed},
      {"force_scale", &FieldLayer::force_scale},
      {"z_m", &FieldLayer::z_m},
      {"core", &FieldLayer::core, kFixed},
      {"probe_charge_c", &FieldLayer::probe_charge_c, kFixed}};
};

template <class L>
concept NamesFile = requires(L layer) { layer.file; };

template <class L>
concept IsGrooves = requires(L layer) { layer.profile; };

template <class L>
concept MayBeAdaptive = requires(L layer) { layer.adaptive; };

template <class L>
concept MayTakeTwoTicks = requires(L layer) { layer.two_ticks; };

/// Calls `use.operator()<L>()` for each kind L of OneOf<...>, in its order.
template <class... Kinds, class Use>
void for_each_kind(const OneOf<Kinds...>* /*of*/, Use use) {
  (use.template operator()<Kinds>(), ...);
}

template <class Use>
void for_each_force_layer_kind(Use use) {
  for_each_kind(static_cast<const ForceLayer*>(nullptr), use);
}

}  // namespace tacto::schema

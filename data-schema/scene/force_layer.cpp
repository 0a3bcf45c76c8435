// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/force_layer.hpp"

#include <array>
#include <type_traits>

#include "data-schema/scene/force_layer_members.hpp"
#include "data-schema/scene/patch.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<std::string_view, 3> kProfileWords = {"sine", "triangle", "square"};
constexpr std::array<std::string_view, 2> kCombineWords = {"topmost", "add"};

}  // namespace

std::string_view to_string(GrooveProfile profile) {
  return kProfileWords[static_cast<std::size_t>(profile)];
}

std::string_view to_string(PatchCombine combine) {
  return kCombineWords[static_cast<std::size_t>(combine)];
}

std::string_view type_of(const ForceLayer& layer) {
  return layer.visit([]<class L>(const L& /*of*/) { return LayerMembers<L>::kType; });
}

std::vector<std::string> force_layer_types() {
  std::vector<std::string> types;
  for_each_force_layer_kind([&]<class L>() { types.emplace_back(LayerMembers<L>::kType); });
  return types;
}

std::vector<NamedLayerNumber> numbers_of(const ForceLayer& layer) {
  std::vector<NamedLayerNumber> numbers;
  layer.visit([&]<class L>(const L& of) {
    for (const auto& member : LayerMembers<L>::kNumbers)
      numbers.push_back({member.name, of.*member.number, member.changes, member.whole});
    if constexpr (IsGrooves<L>)
      if (of.filter_m) numbers.push_back({"filter_m", *of.filter_m, kFixed});
  });
  return numbers;
}

bool is_adaptive(const ForceLayer& layer) {
  return layer.visit([]<class L>(const L& of) {
    if constexpr (MayBeAdaptive<L>) return of.adaptive;
    return false;
  });
}

void clear_adaptive(ForceLayer& layer) {
  layer.visit([]<class L>(L& of) {
    if constexpr (MayBeAdaptive<L> && !std::is_const_v<L>) of.adaptive = false;
  });
}

bool is_added(const ForceLayer& layer) {
  return layer.visit([](const DamperLayer& damper) { return damper.added; },
                     [](const auto& /*other*/) { return false; });
}

std::string file_of(const ForceLayer& layer) {
  return layer.visit([]<class L>(const L& of) -> std::string {
    if constexpr (NamesFile<L>) return of.file;
    return {};
  });
}

}  // namespace tacto::schema

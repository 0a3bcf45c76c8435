// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/force_layer_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/scene/force_layer_members.hpp"

namespace tacto::schema {
namespace {

constexpr const char* kAuto = "auto";
constexpr std::array kProfiles = {GrooveProfile::sine, GrooveProfile::triangle, GrooveProfile::square};

LayerNumber layer_number_from(const Json& body) {
  if (!body.is_object()) return {body.get<double>()};
  const Json& slider = body["slider"];
  return {body["value"], SliderRange{slider["from"], slider["to"]}};
}

// Whole numbers are written without a decimal point; one that is not whole is refused by the schema.
Json plain_number(double value, bool whole) {
  if (whole && std::trunc(value) == value && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

Json layer_number_body(const LayerNumber& number, bool whole = false) {
  Json value = plain_number(number.value, whole);
  if (!number.slider) return value;
  const Json slider = {{"from", plain_number(number.slider->from, whole)},
                       {"to", plain_number(number.slider->to, whole)}};
  return {{"value", value}, {"slider", slider}};
}

// The schema of one kind: of the definition's members those that belong to it.
template <class L>
Json made_rule() {
  const Json& all = scene_definition("force_layer")["properties"];
  Json mine = {{"type", all["type"]}};
  if constexpr (NamesFile<L>) mine["file"] = all["file"];
  if constexpr (IsGrooves<L>) mine["profile"] = all["profile"];
  for (const auto& member : LayerMembers<L>::kNumbers)
    mine[std::string(member.name)] = all[std::string(member.name)];
  if constexpr (IsGrooves<L>) mine["filter_m"] = all["filter_m"];
  if constexpr (MayBeAdaptive<L>) mine["adaptive"] = all["adaptive"];
  if constexpr (MayTakeTwoTicks<L>) mine["two_ticks"] = all["two_ticks"];
  return {{"properties", mine}};
}

template <class L>
const Json& rule_of_kind() {
  static const Json kRule = made_rule<L>();
  return kRule;
}

void read_shape(GroovesLayer& layer, const Json& body) {
  const auto named = [&](GrooveProfile profile) { return to_string(profile) == text_or(body, "profile"); };
  layer.profile = *std::ranges::find_if(kProfiles, named);
  if (body.contains("filter_m") && !body["filter_m"].is_string())
    layer.filter_m = layer_number_from(body["filter_m"]);
}

template <class L>
Result<ForceLayer> layer_of_kind(const Json& body, UnknownMembers unknown, const std::string& where) {
  const Json& rule = rule_of_kind<L>();
  if (unknown == UnknownMembers::refused) TACTO_TRY(check_members_known(rule, body, where));
  L layer;
  if constexpr (NamesFile<L>) layer.file = text_or(body, "file");
  if constexpr (IsGrooves<L>) read_shape(layer, body);
  if constexpr (MayBeAdaptive<L>) layer.adaptive = body.value("adaptive", false);
  if constexpr (MayTakeTwoTicks<L>) layer.two_ticks = body.value("two_ticks", false);
  for (const auto& [name, number, changes, whole] : LayerMembers<L>::kNumbers)
    if (const auto at = body.find(std::string(name)); at != body.end())
      layer.*number = layer_number_from(*at);
  layer.extra_json = unknown_parts(rule, body);
  return layer;
}

Error unknown_type(const std::string& type, const std::string& where) {
  const auto types = force_layer_types();
  const std::string nearest = nearest_word(type, types);
  return {ErrorKind::unsuitable, fmt::format("the type of layer {} is not known", quoted_name(type)),
          where + "/type",
          nearest.empty() ? fmt::format("the types are {}", fmt::join(types, ", "))
                          : fmt::format("did you mean '{}'?", nearest)};
}

}  // namespace

const Json& scene_definition(const char* name) {
  const Json& patch = (*schema_of("scene"))["properties"]["patches"]["items"];
  return std::string_view(name) == "patch" ? patch : patch["properties"]["layers"]["items"];
}

Result<ForceLayer> force_layer_from(const Json& body, UnknownMembers unknown, const std::string& where) {
  const std::string type = text_or(body, "type");
  std::optional<Result<ForceLayer>> read;
  for_each_force_layer_kind([&]<class L>() {
    if (LayerMembers<L>::kType == type) read = layer_of_kind<L>(body, unknown, where);
  });
  return read ? std::move(*read) : tl::unexpected(unknown_type(type, where));
}

Json force_layer_body(const ForceLayer& layer) {
  Json body = {{"type", type_of(layer)}};
  layer.visit([&]<class L>(const L& of) {
    if constexpr (NamesFile<L>) body["file"] = of.file;
    if constexpr (IsGrooves<L>) body["profile"] = to_string(of.profile);
    for (const auto& [name, number, changes, whole] : LayerMembers<L>::kNumbers)
      body[std::string(name)] = layer_number_body(of.*number, whole);
    if constexpr (IsGrooves<L>)
      body["filter_m"] = of.filter_m ? layer_number_body(*of.filter_m) : Json(kAuto);
    if constexpr (MayBeAdaptive<L>)
      if (of.adaptive) body["adaptive"] = true;
    if constexpr (MayTakeTwoTicks<L>)
      if (of.two_ticks) body["two_ticks"] = true;
    add_unknown_parts(rule_of_kind<L>(), body, of.extra_json);
  });
  return body;
}

}  // namespace tacto::schema

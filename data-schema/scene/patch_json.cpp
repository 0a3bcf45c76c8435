// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/patch_json.hpp"

#include <fmt/format.h>

#include "data-schema/json/json_document.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/scene/force_layer_json.hpp"

namespace tacto::schema {
namespace {

// Without its layers: they keep their own.
std::string unknown_beside_layers(Json body) {
  body.erase("layers");
  return unknown_parts(scene_definition("patch"), body);
}

}  // namespace

Result<Patch> patch_from(const Json& body, UnknownMembers unknown, const std::string& where) {
  Patch patch;
  patch.name = text_or(body, "name");
  patch.x_m = body["place"]["x_m"];
  patch.y_m = body["place"]["y_m"];
  patch.width_m = body["size"]["width_m"];
  patch.height_m = body["size"]["height_m"];
  patch.angle_deg = number_or(body, "angle_deg", 0);
  patch.order = number_or(body, "order", 0);
  patch.combine = text_or(body, "combine") == "add" ? PatchCombine::add : PatchCombine::topmost;
  for (const Json& layer_body : body["layers"]) {
    auto layer =
        force_layer_from(layer_body, unknown, fmt::format("{}/layers/{}", where, patch.layers.size()));
    TACTO_TRY(layer);
    patch.layers.push_back(std::move(*layer));
  }
  patch.extra_json = unknown_beside_layers(body);
  return patch;
}

Json patch_body(const Patch& patch) {
  Json body = {{"name", patch.name}};
  body["place"] = {{"x_m", patch.x_m}, {"y_m", patch.y_m}};
  body["size"] = {{"width_m", patch.width_m}, {"height_m", patch.height_m}};
  body["angle_deg"] = patch.angle_deg;
  body["order"] = patch.order;
  body["combine"] = to_string(patch.combine);
  body["layers"] = Json::array();
  for (const ForceLayer& layer : patch.layers) body["layers"].push_back(force_layer_body(layer));
  add_unknown_parts(scene_definition("patch"), body, patch.extra_json);
  return body;
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/scene/patch_json.hpp"
#include "data-schema/scene/piece_json.hpp"
#include "data-schema/scene/playback_choices_json.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kSceneKind = "scene";
constexpr std::string_view kSceneSuffix = ".scene";
constexpr std::array<std::string_view, 3> kEndsWords = {"stop", "mirror", "loop"};

const Json& scene_rules() {
  return *schema_of(kSceneKind);
}

const Json& layer_rules() {
  return scene_rules()["properties"]["layers"]["items"];
}

TextureLayer texture_layer_from(const Json& body) {
  TextureLayer layer;
  layer.texture = text_or(body, "texture");
  layer.at_m = number_or(body, "at_m", 0);
  layer.gain_m_per_n = number_or(body, "gain_m_per_n", 0);
  layer.gain_set_by = text_or(body, "gain_set_by");
  layer.gain_set_on = text_or(body, "gain_set_on");
  const auto ends = std::ranges::find(kEndsWords, text_or(body, "ends", "stop"));
  layer.ends = static_cast<TextureEnds>(ends - kEndsWords.begin());
  layer.extra_json = unknown_parts(layer_rules(), body);
  return layer;
}

Json texture_layer_body(const TextureLayer& layer) {
  Json body = {{"type", "texture"}, {"texture", layer.texture}};
  body["at_m"] = layer.at_m;
  body["gain_m_per_n"] = layer.gain_m_per_n;
  put_text(body, "gain_set_by", layer.gain_set_by);
  put_text(body, "gain_set_on", layer.gain_set_on);
  body["ends"] = to_string(layer.ends);
  add_unknown_parts(layer_rules(), body, layer.extra_json);
  return body;
}

Json layer_body(const Layer& layer) {
  return layer.visit([](const TextureLayer& texture) { return texture_layer_body(texture); });
}

Result<Layer> layer_from(const Json& body, const std::string& place) {
  if (const std::string type = text_or(body, "type"); type != "texture")
    return fail(ErrorKind::unsuitable, fmt::format("'{}' is not a known type of layer", type),
                place + "/type", "the types are: texture");
  return texture_layer_from(body);
}

// If there are several textures along a path, the space beyond one's ends belongs to another.
Result<void> check_ends(const Scene& scene, const std::string& where) {
  const auto goes_on = [](const Layer& layer) {
    return layer.visit([](const TextureLayer& texture) { return texture.ends != TextureEnds::stop; });
  };
  if (scene.layers.size() <= 1) return {};
  const auto layer = std::ranges::find_if(scene.layers, goes_on);
  if (layer == scene.layers.end()) return {};
  return fail(ErrorKind::unsuitable, "with several textures none can continue beyond its ends",
              fmt::format("{}#/layers/{}/ends", where, layer - scene.layers.begin()), R"(make it "stop")");
}

Result<void> read_layers(const Document& document, const std::string& where, Scene& scene) {
  if (!document.body.contains("layers")) return {};
  for (const Json& body : document.body["layers"]) {
    auto layer = layer_from(body, fmt::format("{}#/layers/{}", where, scene.layers.size()));
    TACTO_TRY(layer);
    scene.layers.push_back(std::move(*layer));
  }
  return {};
}

Result<void> read_patches(const Document& document, const std::string& where, Scene& scene) {
  if (!document.body.contains("patches")) return {};
  const auto unknown = document.newer_version.empty() ? UnknownMembers::refused : UnknownMembers::kept;
  for (const Json& body : document.body["patches"]) {
    auto patch = patch_from(body, unknown, fmt::format("{}#/patches/{}", where, scene.patches.size()));
    TACTO_TRY(patch);
    scene.patches.push_back(std::move(*patch));
  }
  return {};
}

void read_pieces(const Document& document, Scene& scene) {
  if (!document.body.contains("pieces")) return;
  for (const Json& body : document.body["pieces"]) scene.pieces.push_back(piece_from(body));
  scene.point_radius_m = number_or(document.body, "radius_m", 0);
  scene.contact = contact_from(document.body);
  if (!document.body.contains("tool_m")) return;
  for (const Json& point : document.body["tool_m"]) scene.tool_m.push_back({point[0], point[1], point[2]});
}

// Layers, patches and choices keep their own.
std::string unknown_beside_parts(Json body) {
  for (const char* part : {"layers", "patches", "playback"}) body.erase(part);
  return unknown_parts(scene_rules(), body);
}

Result<Scene> scene_from(const Document& document, const std::string& where) {
  Scene scene;
  TACTO_TRY(read_layers(document, where, scene));
  TACTO_TRY(read_patches(document, where, scene));
  TACTO_TRY(check_document_known(document, kSceneKind, where));
  read_pieces(document, scene);
  TACTO_TRY(check_ends(scene, where));
  TACTO_TRY(check_patches(scene, where));
  TACTO_TRY(check_pieces(scene, where));
  scene.name = text_or(document.body, "name");
  scene.notes = text_or(document.body, "notes");
  scene.created = text_or(document.body, "created");
  scene.creator = text_or(document.body, "creator");
  scene.playback = playback_choices_in(document.body);
  keep_unknown(document, scene);
  scene.extra_json = unknown_beside_parts(document.body);
  return scene;
}

Json scene_body(const Scene& scene) {
  Json body = Json::object();
  put_text(body, "version", scene.newer_version);
  put_text(body, "name", scene.name);
  put_text(body, "notes", scene.notes);
  put_text(body, "created", scene.created);
  put_text(body, "creator", scene.creator);
  if (Json playback = playback_choices_body(scene.playback); !playback.empty()) body["playback"] = playback;
  if (!scene.layers.empty() || (scene.patches.empty() && scene.pieces.empty()))
    body["layers"] = Json::array();
  for (const Layer& layer : scene.layers) body["layers"].push_back(layer_body(layer));
  for (const Patch& patch : scene.patches) body["patches"].push_back(patch_body(patch));
  if (scene.pieces.empty()) return body;
  body["contact"] = to_string(scene.contact);
  if (scene.point_radius_m > 0) body["radius_m"] = scene.point_radius_m;
  for (const auto& point : scene.tool_m) body["tool_m"].push_back(point);
  for (const Piece& piece : scene.pieces) body["pieces"].push_back(piece_body(piece));
  return body;
}

}  // namespace

std::string_view to_string(TextureEnds ends) {
  return kEndsWords[static_cast<std::size_t>(ends)];
}

std::string scene_path(const std::string& name) {
  return stem_of(name, kSceneSuffix) + std::string(kSceneSuffix) + ".json";
}

Result<Scene> parse_scene(std::string_view text, const std::string& where) {
  const auto document = parse_document(text, where, kSceneKind);
  return document ? scene_from(*document, where) : forward_error(document);
}

Result<Scene> read_scene(const std::string& name) {
  const std::string path = scene_path(name);
  const auto document = open_document(path, kSceneKind);
  return document ? scene_from(*document, path) : forward_error(document);
}

Result<std::string> scene_json(const Scene& scene, const std::string& where) {
  auto text = document_text(kSceneKind, scene_body(scene), scene.extra_json);
  TACTO_TRY(text);
  TACTO_TRY(check_patches(scene, where));
  TACTO_TRY(check_pieces(scene, where));
  return text;
}

Result<void> write_scene(const std::string& stem, const Scene& scene) {
  const std::string path = scene_path(stem);
  const auto text = scene_json(scene, path);
  TACTO_TRY(text);
  if (is_file(path))
    if (const auto free = check_changeable(path); !free) return free;
  PendingFiles pending;
  if (const auto written = pending.write(path, *text); !written) return written;
  return pending.commit();
}

std::string texture_in_scene(const std::string& scene_path, const std::string& texture) {
  return (std::filesystem::path(scene_path).parent_path() / texture).string();
}

}  // namespace tacto::schema

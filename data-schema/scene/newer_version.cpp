// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/newer_version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

std::vector<std::string> member_names(const std::string& extra_json, const std::string& place) {
  std::vector<std::string> names;
  if (extra_json.empty()) return names;
  const Json extra = Json::parse(extra_json);
  for (const auto& member : extra.items()) names.push_back(place + member.key());
  return names;
}

namespace {

// Extras of patches may be within objects that are known: the innermost names.
std::vector<std::string> innermost_names(const std::string& extra_json, const std::string& place) {
  std::vector<std::string> names;
  if (extra_json.empty()) return names;
  const Json extra = Json::parse(extra_json).flatten();  // a variable: items() would outlive a temporary
  for (const auto& member : extra.items()) names.push_back(place + member.key().substr(1));
  return names;
}

void add_names_of_patches(const Scene& scene, std::vector<std::string>& names) {
  const auto add = [&](const std::string& extra_json, const std::string& place) {
    std::ranges::copy(innermost_names(extra_json, place), std::back_inserter(names));
  };
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const Patch& patch = scene.patches[i];
    add(patch.extra_json, fmt::format("patches/{}/", i));
    for (std::size_t j = 0; j < patch.layers.size(); ++j)
      add(extra_of(patch.layers[j]), fmt::format("patches/{}/layers/{}/", i, j));
  }
}

}  // namespace

std::string note_of_newer_version(const std::string& path, const std::string& newer_version,
                                  const std::vector<std::string>& passed_over) {
  if (newer_version.empty()) return {};
  const std::string names = passed_over.empty() ? "" : fmt::format(": {}", fmt::join(passed_over, ", "));
  return fmt::format("{}: its version {} is newer than this program's; unknown members are ignored{}", path,
                     newer_version, names);
}

std::string note_of_newer_version(const std::string& path, const Scene& scene) {
  std::vector<std::string> names = member_names(scene.extra_json);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const std::string extra =
        scene.layers[i].visit([](const TextureLayer& layer) { return layer.extra_json; });
    std::ranges::copy(member_names(extra, fmt::format("layers/{}/", i)), std::back_inserter(names));
  }
  add_names_of_patches(scene, names);
  return note_of_newer_version(path, scene.newer_version, names);
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/texture_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "data-schema/command/output_options.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::spatial {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPlace = "{}";

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return path.ends_with('/') || fs::is_directory(path, ignored);
}

std::string texture_stem(const std::string& recording, const std::string& output) {
  const std::string stem = schema::stem_of(recording, "");
  if (output.empty()) return schema::stem_of(stem, ".texture");
  const std::string name = fs::path(stem).filename().string();
  if (is_folder(output)) return (fs::path(output) / name).string();
  std::string named = output;
  if (const std::size_t place = named.find(kPlace); place != std::string::npos)
    named.replace(place, kPlace.size(), name);
  return schema::stem_of(named, ".texture");
}

// The part after NAME in NAME-01 or NAME-forward.
bool is_ending(std::string_view ending) {
  if (ending.empty() || ending == "-forward" || ending == "-backward") return true;
  return ending.size() > 2 && ending.front() == '-' &&
         std::ranges::all_of(ending.substr(1), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool names_one_texture(const std::string& output) {
  return !output.empty() && !is_folder(output) && output.find(kPlace) == std::string::npos;
}

schema::Result<std::vector<std::string>> texture_stems(const std::vector<std::string>& recordings,
                                                       const std::string& output) {
  if (!is_folder(output))
    TACTO_TRY(
        cli::check_ending(schema::stem_of(output, ".texture"), {},
                          "give the name without it: a texture is NAME.texture.wav and NAME.texture.json"));
  std::vector<std::string> stems;
  std::map<std::string, std::string> named, taken;
  for (const std::string& recording : recordings) {
    const auto [same, fresh] =
        named.emplace(schema::canonical_path(schema::stem_of(recording, "")), recording);
    if (!fresh)
      return schema::fail(schema::ErrorKind::usage, fmt::format("is the same recording as {}", same->second),
                          recording, "give it once");
    stems.push_back(texture_stem(recording, output));
    if (!taken.emplace(schema::canonical_path(stems.back()), recording).second)
      return schema::fail(
          schema::ErrorKind::usage,
          fmt::format("the textures of several recordings would be named {}", stems.back()), {},
          fmt::format(
              "-o {}/ writes them into a folder of that name; in a name, {{}} stands for the name of the "
              "recording",
              output));
  }
  return stems;
}

std::vector<std::string> other_textures(const std::string& stem, const std::vector<std::string>& made) {
  constexpr std::string_view kSuffix = ".texture.json";
  const fs::path name = fs::path(stem).filename(), folder = fs::path(stem).parent_path();
  std::vector<std::string> others;
  std::error_code failed;
  for (fs::directory_iterator file(folder.empty() ? "." : folder, failed), end; !failed && file != end;
       file.increment(failed)) {
    const std::string found = file->path().filename().string();
    if (!found.ends_with(kSuffix) || !found.starts_with(name.string())) continue;
    const std::string other = found.substr(0, found.size() - kSuffix.size());
    const bool ours = std::ranges::find(made, (folder / other).string()) != made.end();
    if (!ours && is_ending(std::string_view(other).substr(name.string().size())))
      others.push_back((folder / found).string());
  }
  std::ranges::sort(others);
  return others;
}

}  // namespace tacto::spatial

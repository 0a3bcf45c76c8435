// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/take_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

namespace tacto::capture {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr int kMostTakes = 9999;

// The stems in each folder. Each folder is read once, because thousands of take numbers may be tested.
class TakenStems {
 public:
  bool holds(const std::string& stem) {
    const fs::path path(stem);
    const auto [folder, is_new] = folders_.try_emplace(path.parent_path().string());
    if (is_new) folder->second = stems_in(folder->first);
    return folder->second.contains(path.filename().string());
  }

 private:
  static std::set<std::string> stems_in(const std::string& folder) {
    std::set<std::string> stems;
    std::error_code failed;
    for (fs::directory_iterator at(folder.empty() ? "." : folder, failed), end; !failed && at != end;
         at.increment(failed)) {
      const std::string name = at->path().filename().string();
      for (const std::string_view ending : {".wav", ".json", ".events.jsonl"})
        if (name.ends_with(ending)) stems.insert(name.substr(0, name.size() - ending.size()));
    }
    return stems;
  }

  std::map<std::string, std::set<std::string>> folders_;
};

// UTF-8 beyond ASCII is kept: names of surfaces may be in any language.
std::string file_safe(std::string text) {
  std::ranges::replace_if(
      text,
      [](char c) {
        const auto code = static_cast<unsigned char>(c);
        return code < 0x80 && std::isalnum(code) == 0 && c != '.' && c != '-' && c != '_';
      },
      '-');
  return text;
}

std::string known(const NameParts& parts) {
  std::string names = "{take}";
  for (const auto& [name, value] : parts) names += ", {" + name + "}";
  return names;
}

Result<std::string> part_of(const std::string& name, const NameParts& parts, int take) {
  if (name == "take") return fmt::format("{}", take);
  const auto found = std::ranges::find(parts, name, &std::pair<std::string, std::string>::first);
  if (found == parts.end())
    return fail(ErrorKind::usage, fmt::format("{{{}}} is not a placeholder", name), "--template",
                "the placeholders are " + known(parts));
  if (found->second.empty())
    return fail(ErrorKind::usage, fmt::format("{{{}}} is empty", name), "--template",
                fmt::format("give it with --{}", name));
  return file_safe(found->second);
}

Result<std::string> filled(const std::string& pattern, const NameParts& parts, int take) {
  std::string name;
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    if (pattern[at] != '{') {
      name += pattern[at];
      continue;
    }
    const auto close = pattern.find('}', at);
    if (close == std::string::npos)
      return fail(ErrorKind::usage, "a brace is not closed", "--template",
                  "the placeholders are " + known(parts));
    const auto part = part_of(pattern.substr(at + 1, close - at - 1), parts, take);
    if (!part) return part;
    name += *part;
    at = close;
  }
  return name;
}

}  // namespace

Result<std::string> name_of_take(const std::string& pattern, const NameParts& parts) {
  const bool counts = pattern.find("{take}") != std::string::npos;
  TakenStems taken;
  auto next = filled(pattern, parts, counts ? kMostTakes : 1);
  if (!next) return next;
  if (taken.holds(*next))
    return fail(ErrorKind::usage,
                counts ? fmt::format("take {} exists already", kMostTakes)
                       : "a recording of that name exists already",
                pattern, counts ? "choose another template" : "add {take} to it, which counts up");
  for (int take = (counts ? kMostTakes : 1) - 1; take >= 1; --take) {
    auto name = filled(pattern, parts, take);
    if (!name || taken.holds(*name)) break;
    next = std::move(name);
  }
  return next;
}

}  // namespace tacto::capture

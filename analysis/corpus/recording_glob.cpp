// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/recording_glob.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <span>

#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;
using Names = std::span<const std::string>;

constexpr std::string_view kAnyFolders = "**";

bool has_wildcard(const std::string& name) {
  return name.find_first_of("*?[") != std::string::npos;
}

bool matches(Names pattern, Names path) {
  if (pattern.empty()) return path.empty();
  if (pattern.front() != kAnyFolders)
    return !path.empty() && fnmatch(pattern.front().c_str(), path.front().c_str(), FNM_PERIOD) == 0 &&
           matches(pattern.subspan(1), path.subspan(1));
  for (std::size_t skipped = 0; skipped <= path.size(); ++skipped)
    if (matches(pattern.subspan(1), path.subspan(skipped))) return true;
  return false;
}

// A pattern in the folder without wildcards and the names below it.
struct Pattern {
  fs::path folder;
  std::vector<std::string> names;
};

Pattern pattern_of(const std::string& text) {
  std::error_code ignored;
  if (fs::is_directory(text, ignored)) return {text, {std::string(kAnyFolders), "*.json"}};
  if (schema::is_file(text) || schema::is_file(text + ".json")) return {text, {}};  // also a name with [ or *
  Pattern pattern;
  for (const fs::path& part : fs::path(text))
    if (pattern.names.empty() && !has_wildcard(part.string()))
      pattern.folder /= part;
    else
      pattern.names.push_back(part.string());
  return pattern;
}

bool is_recording(const std::string& path) {
  if (schema::has_ending_of_kind(path)) return false;
  if (schema::is_file(path.substr(0, path.size() - 5) + ".wav")) return true;
  const auto files = schema::stored_files(path);
  return files && files->front().kind == schema::FileKind::recording;
}

class Search {
 public:
  Result<void> find(const std::string& text) {
    const Pattern pattern = pattern_of(text);
    const std::size_t before = found_.size() + known_;
    if (pattern.names.empty())
      take(schema::is_file(text + ".json") ? text + ".json" : text);
    else
      TACTO_TRY(walk(pattern, text));
    if (found_.size() + known_ > before) return {};
    return schema::fail(ErrorKind::not_found, "names no recording", text,
                        "quote a pattern, for example 'raw/**/*.json'");
  }

  FoundRecordings result() && { return {{found_.begin(), found_.end()}, others_}; }

 private:
  Result<void> walk(const Pattern& pattern, const std::string& text) {
    const fs::path from = pattern.folder.empty() ? "." : pattern.folder;
    const bool any_depth = std::ranges::find(pattern.names, kAnyFolders) != pattern.names.end();
    std::error_code failed;
    for (fs::recursive_directory_iterator at(from, failed), end; !failed && at != end; at.increment(failed)) {
      const fs::path below = at->path().lexically_relative(from);
      const std::vector<std::string> names(below.begin(), below.end());
      std::error_code ignored;
      if (at->is_directory(ignored)) {
        if (names.back().starts_with('.') || (!any_depth && names.size() >= pattern.names.size()))
          at.disable_recursion_pending();
      } else if (matches(pattern.names, names)) {
        take((pattern.folder / below).string());
      }
    }
    if (failed)
      return schema::fail(ErrorKind::not_found, from.string() + " cannot be listed: " + failed.message(),
                          text);
    return {};
  }

  void take(const std::string& path) {
    if (!path.ends_with(".json") || !schema::is_file(path)) return;
    if (!is_recording(path))
      ++others_;
    else if (!found_.insert(fs::path(path).lexically_normal().string()).second)
      ++known_;
  }

  std::set<std::string> found_;
  std::size_t known_ = 0, others_ = 0;
};

}  // namespace

Result<FoundRecordings> find_recordings(const std::vector<std::string>& patterns) {
  Search search;
  for (const std::string& pattern : patterns) TACTO_TRY(search.find(pattern));
  return std::move(search).result();
}

}  // namespace tacto::analysis

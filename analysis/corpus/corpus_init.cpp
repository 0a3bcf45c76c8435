// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_init.hpp"

#include <fnmatch.h>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "analysis/corpus/corpus_steps.hpp"
#include "analysis/corpus/corpus_unit.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::Result;

struct FoundRecordings {
  std::vector<std::string> paths;  ///< of sidecars, sorted, each once
  std::size_t others = 0;          ///< JSON files that are no recordings
};

using schema::ErrorKind;
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
    fs::path folder = from;  // the one that is entered next
    for (fs::recursive_directory_iterator at(from, failed), end; !failed && at != end; at.increment(failed)) {
      folder = at->path();
      const fs::path below = folder.lexically_relative(from);
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
      return schema::fail(ErrorKind::not_found, folder.string() + " cannot be listed: " + failed.message(),
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

// Each pattern is a recording, a folder (with its subfolders), or a path with * ? [...] in names, and ** for
// any number of folders. Names that begin with a dot, and links to folders, are skipped. A JSON file with a
// WAV beside it counts as a recording even if it is damaged. Errors: not_found, if a pattern names no
// recording.
Result<FoundRecordings> find_recordings(const std::vector<std::string>& patterns) {
  Search search;
  for (const std::string& pattern : patterns) TACTO_TRY(search.find(pattern));
  return std::move(search).result();
}

// Relative paths start at the study's folder, so that both can be moved together. Links to folders are
// resolved, because ".." behind one leads elsewhere; the recording's own name stays.
class PathsInPlan {
 public:
  explicit PathsInPlan(const std::string& study) : study_(schema::canonical_path(study)) {
    if (!study_.has_filename()) study_ = study_.parent_path();  // "study/"
  }

  std::string of(const fs::path& path) {
    if (path.is_absolute()) return path.string();
    auto& folder = folders_[path.parent_path().string()];
    if (folder.empty()) folder = schema::canonical_path(path.has_parent_path() ? path.parent_path() : ".");
    return (fs::path(folder) / path.filename()).lexically_relative(study_).string();
  }

 private:
  fs::path study_;
  std::map<std::string, std::string> folders_;  // canonical
};

}  // namespace

Result<NewCorpus> init_corpus(const CorpusInput& input, const std::function<void(double)>& progress) {
  const std::string path = corpus_plan_path(input.study);
  TACTO_TRY(schema::check_output_free(path, input.existing));
  TACTO_TRY(parse_steps(input.steps));
  const auto found = find_recordings(input.patterns);
  TACTO_TRY(found);
  PathsInPlan paths(input.study);
  NewCorpus made{{input.steps, {}, schema::creation_time(), std::string(kCreator), {}, {}, {}},
                 found->others};
  auto& recordings = made.plan.recordings;
  recordings.reserve(found->paths.size());
  for (const std::string& recording : found->paths) {
    auto sum = schema::sha256_of_file(recording);
    TACTO_TRY(sum);
    recordings.push_back({paths.of(recording), std::move(*sum)});
    progress(static_cast<double>(recordings.size()) / static_cast<double>(found->paths.size()));
  }
  const auto text = schema::corpus_plan_json(made.plan);
  TACTO_TRY(text);
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(path, *text));
  TACTO_TRY(pending.commit(input.existing));
  return made;
}

}  // namespace tacto::analysis

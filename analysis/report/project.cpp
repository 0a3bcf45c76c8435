// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/report/project.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "data-schema/files.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::Fault;
using schema::Result;

bool hidden(const fs::path& path) {
  return path.filename().string().starts_with(".");
}

// Every file below the folder, by name.
Result<std::vector<std::string>> files_below(const std::string& folder, const std::string& leave_out) {
  std::error_code failure, ignored;
  fs::recursive_directory_iterator at(folder, failure);
  if (failure)
    return schema::fail(Fault::not_found, "the folder can't be read: " + failure.message(), folder,
                        "name the folder that holds the project's files");
  std::vector<std::string> files;
  for (; at != fs::recursive_directory_iterator(); at.increment(failure)) {
    if (failure) break;
    if (hidden(at->path())) {
      at.disable_recursion_pending();
      continue;
    }
    const bool left_out = !leave_out.empty() && fs::equivalent(at->path(), leave_out, ignored);
    if (at->is_regular_file(ignored) && !left_out) files.push_back(at->path().string());
  }
  std::ranges::sort(files);
  return files;
}

bool is_sidecars_wav(const std::string& path) {
  return path.ends_with(".wav") && schema::is_file(path.substr(0, path.size() - 4) + ".json");
}

bool is_journal(const std::string& path) {
  return path.ends_with(".events.jsonl");
}

bool may_be_ours(const std::string& path) {
  return path.ends_with(".json") || path.ends_with(".nc") || path.ends_with(".session");
}

void add_file(const std::string& path, Project& project) {
  if (is_sidecars_wav(path)) return;
  if (is_journal(path)) {
    project.broken.push_back({path,
                              {Fault::malformed, "is of a recording that was never closed", path,
                               "'tactograph recover' makes it whole"}});
    return;
  }
  if (!may_be_ours(path)) {
    project.foreign.push_back(path);
    return;
  }
  const auto stored = schema::stored_files(path);
  auto file = stored ? project_file(stored->front()) : tl::unexpected(stored.error());
  if (file)
    project.files.push_back(std::move(*file));
  else
    project.broken.push_back({path, file.error()});
}

}  // namespace

Result<Project> read_project(const std::string& folder, const std::string& leave_out,
                             const std::function<void(double)>& progress) {
  const auto paths = files_below(folder, leave_out);
  if (!paths) return schema::forward_error(paths);
  Project project;
  project.folder = folder;
  for (std::size_t i = 0; i < paths->size(); ++i) {
    if (progress) progress(static_cast<double>(i) / static_cast<double>(paths->size()));
    add_file((*paths)[i], project);
  }
  if (project.files.empty() && project.broken.empty())
    return schema::fail(Fault::unsuitable, "holds no file of tactograph", folder, "name a project's folder");
  std::ranges::stable_sort(project.files, {}, &ProjectFile::kind);
  return project;
}

}  // namespace tacto::analysis

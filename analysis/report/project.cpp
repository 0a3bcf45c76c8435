// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/report/project.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "analysis/page/picture_svg.hpp"
#include "data-schema/files/files.hpp"
#include "playback/session/session_rows.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;

// Whether the path contains the samples of a readable file, or is a WAV beside an unusable sidecar.
bool is_sidecars_wav(const std::string& path, const Project& project) {
  const auto names = [&](const ProjectFile& file) { return file.data == path; };
  if (std::ranges::any_of(project.files, names)) return true;
  const std::string sidecar = fs::path(path).replace_extension(".json").string();
  return path.ends_with(".wav") &&
         std::ranges::find(project.broken, sidecar, &BrokenFile::path) != project.broken.end();
}

bool is_journal(const std::string& path) {
  return path.ends_with(".events.jsonl");
}

bool may_be_ours(const std::string& path) {
  return path.ends_with(".json") || path.ends_with(".nc") || path.ends_with(".session");
}

// Opening a pipe would block; the target of a broken link is missing.
std::optional<schema::Error> irregular(const std::string& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return std::nullopt;
  if (!fs::exists(path, ignored))
    return schema::Error{ErrorKind::not_found, "is a broken link", path, "restore its target, or remove it"};
  return schema::Error{ErrorKind::unsuitable, "is not a file but a pipe, a socket or a device", path,
                       "remove it, or store its data in a file"};
}

void add_file(const std::string& path, Project& project, const std::function<void(double)>& progress) {
  if (auto error = irregular(path)) {
    project.broken.push_back({path, std::move(*error)});
    return;
  }
  if (is_journal(path)) {
    project.broken.push_back({path,
                              {ErrorKind::malformed, "is of a recording that was never closed", path,
                               "'tactograph recover' repairs it"}});
    return;
  }
  if (!may_be_ours(path)) {
    project.foreign.push_back(path);
    return;
  }
  const auto stored = schema::stored_files(path);
  auto file = stored ? project_file(stored->front(), progress) : tl::unexpected(stored.error());
  if (file)
    project.files.push_back(std::move(*file));
  else
    project.broken.push_back({path, file.error()});
}

}  // namespace

Result<Project> read_project(const std::string& folder, const std::string& leave_out,
                             const std::function<void(double)>& progress) {
  auto below = schema::files_below(folder);
  TACTO_TRY(below);
  auto& paths = below->files;
  std::error_code ignored;
  std::erase_if(paths, [&](const std::string& path) {
    return !leave_out.empty() && fs::equivalent(path, leave_out, ignored);
  });
  Project project;
  project.folder = folder;
  for (schema::Error& closed : below->unreadable) project.broken.push_back({closed.where, std::move(closed)});
  const auto files = static_cast<double>(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double from = static_cast<double>(i) / files, to = static_cast<double>(i + 1) / files;
    add_file(paths[i], project, playback::part_of(progress, from, to));
    if (progress) progress(to);
  }
  if (project.files.empty() && project.broken.empty())
    return schema::fail(ErrorKind::unsuitable, "contains no file of tactograph", folder,
                        "name a project's folder");
  std::erase_if(project.foreign, [&](const std::string& path) { return is_sidecars_wav(path, project); });
  std::ranges::stable_sort(project.files, {}, &ProjectFile::kind);
  return project;
}

void draw_pictures(Project& project) {
  std::erase_if(project.files, [&](ProjectFile& file) {
    auto drawn = pictures_html(file.pictures, file.simulated);
    if (drawn) {
      file.pictures_html = std::move(*drawn);
      return false;
    }
    schema::Error error = drawn.error();
    error.where = file.path + ", " + error.where;
    project.broken.push_back({file.path, std::move(error)});
    return true;
  });
}

}  // namespace tacto::analysis

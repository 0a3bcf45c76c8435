// SPDX-License-Identifier: GPL-3.0-or-later
// The contents of a folder, and the page about it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/report/project_file.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// A file that is unreadable or faulty.
struct BrokenFile {
  std::string path;
  schema::Error error;
};

struct Project {
  std::string folder;
  std::vector<ProjectFile> files;  ///< by kind, then by name
  std::vector<BrokenFile> broken;  ///< tactograph's files that are unusable
  std::vector<std::string>
      foreign;  ///< files that are not described (other programs' files, pictures and drives): names only
};

/// Reads the folder and its subfolders, except hidden ones and links to folders. A file of tactograph is a
/// .json with a kind, a .nc or a .session; a .wav belongs to the sidecar that names it. An unreadable file
/// or folder does not stop the rest; nor do pipes, sockets, devices and broken links, which are not opened.
/// `leave_out` is a path to skip: the page itself. `progress` receives 0 to 1. Errors: not_found: the folder
/// does not exist; unsuitable: it contains no file of tactograph.
schema::Result<Project> read_project(const std::string& folder, const std::string& leave_out,
                                     const std::function<void(double)>& progress = {});

/// Draws the pictures of all files. If a picture cannot be drawn, its file moves from `files` to `broken`,
/// and the rest continues.
void draw_pictures(Project& project);

/// One HTML page that needs no other files: a table of the measurements, then each file with its figures and
/// the pictures that draw_pictures() has drawn.
std::string project_page(const Project& project);

}  // namespace tacto::analysis

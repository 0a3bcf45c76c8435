// SPDX-License-Identifier: GPL-3.0-or-later
// All that a folder holds, and the page about it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/report/project_file.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// A file that could not be read, or that is faulty.
struct BrokenFile {
  std::string path;
  schema::Error error;
};

struct Project {
  std::string folder;
  std::vector<ProjectFile> files;  ///< by kind, then by name
  std::vector<BrokenFile> broken;  ///< files of ours, or that should be
  std::vector<std::string>
      foreign;  ///< what can't be described (other programs' files, our pictures and drives): named
};

/// Looks into the folder and those within it (hidden ones and links to folders are passed over). A file of
/// ours is a .json that says a kind, a .nc, a .session; a .wav goes with the sidecar that names it. One that
/// cannot be read does not stop the rest; nor do pipes, sockets, devices and links that lead nowhere, which
/// are never opened. `leave_out` is a path that is not looked at: the page itself. `progress` hears 0 to 1.
/// Errors: not_found, where there is no such folder; unsuitable, where it holds no file of ours.
schema::Result<Project> read_project(const std::string& folder, const std::string& leave_out,
                                     const std::function<void(double)>& progress = {});

/// Draws the files' pictures. A file with one that cannot be drawn goes from `files` to `broken`: it does not
/// stop the rest.
void draw_pictures(Project& project);

/// One page that needs nothing beside it: what was measured where as a table, then each file with its figures
/// and pictures, as far as draw_pictures() has drawn them.
std::string project_page(const Project& project);

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of this process, in which it computes what it renames when it is complete.
#pragma once

#include <cstddef>
#include <string>
#include <tl/expected.hpp>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

tl::unexpected<schema::Error> unwritable(const std::string& path, int error_number);
schema::Result<void> make_folder(const std::string& path);
void remove_folder(const std::string& path);
/// Everything on the file system of the folder, by one call.
schema::Result<void> sync_file_system(const std::string& folder);

/// ALL/PROCESS, named as temporary files are, so that a later run recognises it. The destructor removes it,
/// and ALL unless another process works there.
class WorkFolder {
 public:
  explicit WorkFolder(std::string all);
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  ~WorkFolder();

  schema::Result<void> make() const { return make_folder(own_); }
  std::string of(const std::string& name) const { return own_ + "/" + name; }
  /// Removes those of processes that have ended, and returns their number. On another machine a process may
  /// run: its folder stays.
  std::size_t remove_ended() const;

 private:
  std::string all_, own_;
};

}  // namespace tacto::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
// Folders that are made for outputs.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

struct PendingName;

/// Makes the missing folders of outputs. Those that are empty at the end are removed again: by the
/// destructor, or by the handler of a signal that ends the process (remove_pending_files).
class MadeFolders {
 public:
  MadeFolders() = default;
  MadeFolders(MadeFolders&&) noexcept = default;
  MadeFolders& operator=(MadeFolders&& other) noexcept;
  ~MadeFolders();

  /// The folder of the file `path` and those above it, synced to disk. Errors: cannot_write.
  Result<void> make_for(const std::string& path);

 private:
  std::vector<PendingName*> made_;  // outer folders first
};

/// The nearest folder above the file `path` that exists.
std::string existing_folder_of(const std::string& path);

}  // namespace tacto::schema

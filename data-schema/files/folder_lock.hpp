// SPDX-License-Identifier: GPL-3.0-or-later
// Who changes a file in a folder does so alone.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Held while a file is read, changed and replaced: a lock on the file itself would stay with the one that
/// was replaced. Holds among all programs that take it; where a file system has no such locks it is none.
class FolderLock {
 public:
  /// Waits for whoever has the folder of `path`, which must be there. Errors: cannot_write.
  static Result<FolderLock> take(const std::string& path);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// A lock for changing a file in a folder.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Held while a file is read, changed and replaced: a lock on the file itself would stay with the replaced
/// file. It works between all programs that use it; without effect on a file system without such locks.
class FolderLock {
 public:
  /// Waits until the lock of the folder of `path` is free; the folder must exist. Errors: cannot_write.
  static Result<FolderLock> take(const std::string& path);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "data-schema/files/event_file.hpp"

namespace tacto::schema {

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<FolderLock> FolderLock::take(const std::string& path) {
  const std::string folder = folder_of(path);
  const int opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0)
    return fail(ErrorKind::cannot_write, "cannot be opened: " + std::generic_category().message(errno),
                folder);
  FolderLock lock(opened);
  while (flock(opened, LOCK_EX) != 0 && errno == EINTR) {
  }
  return lock;
}

}  // namespace tacto::schema

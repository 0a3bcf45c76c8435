// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/event_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

constexpr off_t kRoom = off_t{256} * 1024;  // a sidecar with some thousand gaps and clock pairs

tl::unexpected<Error> unwritable_log(const std::string& path, int error_number) {
  if (error_number == EEXIST)
    return fail(ErrorKind::usage, "exists already, and is not overwritten", path, "choose another name");
  return fail(ErrorKind::cannot_write, "cannot be written: " + std::generic_category().message(error_number),
              path);
}

std::string kernel_name_of(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

}  // namespace

EventFile::EventFile(EventFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

EventFile& EventFile::operator=(EventFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

EventFile::~EventFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<EventFile> EventFile::create(const std::string& path) {
  const int opened = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
  if (opened < 0) return unwritable_log(path, errno);
  EventFile file(path, opened);
  flock(opened, LOCK_EX | LOCK_NB);  // no other process has the lock: the file is new
  // On a file system that cannot reserve room, a full disk may leave a recording that has to be recovered.
  [[maybe_unused]] const int kept = fallocate(opened, FALLOC_FL_KEEP_SIZE, 0, kRoom);
  return file;
}

Result<EventFile> EventFile::lock(const std::string& path) {
  const int opened = open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (opened < 0)
    return fail(ErrorKind::not_found, "cannot be opened: " + std::generic_category().message(errno), path);
  EventFile file(path, opened);
  if (flock(opened, LOCK_EX | LOCK_NB) == 0) return file;
  return fail(ErrorKind::unsuitable, "is still being recorded", path, "stop the recording first");
}

Result<void> EventFile::append(const std::string& text) {
  const ssize_t done = ::write(descriptor_, text.data(), text.size());
  if (done == static_cast<ssize_t>(text.size())) return {};
  return unwritable_log(path_, done < 0 ? errno : ENOSPC);
}

void EventFile::release_room() {
  struct stat status {};
  if (fstat(descriptor_, &status) == 0) [[maybe_unused]]
    const int cut = ftruncate(descriptor_, status.st_size);
}

Result<void> EventFile::remove() {
  return unlink(path_.c_str()) == 0 ? Result<void>{} : unwritable_log(path_, errno);
}

// Identifies files by device and inode, without /proc.
bool EventFile::is_at_its_path() const {
  struct stat here {
  }, there{};
  return fstat(descriptor_, &here) == 0 && stat(path_.c_str(), &there) == 0 && here.st_dev == there.st_dev &&
         here.st_ino == there.st_ino;
}

bool EventFile::is_deleted() const {
  struct stat status {};
  return fstat(descriptor_, &status) == 0 && status.st_nlink == 0;
}

std::string EventFile::place() const {
  std::error_code unknown;
  const auto place = std::filesystem::read_symlink(kernel_name_of(descriptor_), unknown);
  return is_file(place.string()) ? place.string() : "";
}

Result<void> sync_path(const std::string& path) {
  const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (opened < 0) return unwritable_log(path, errno);
  const int failed = fsync(opened) == 0 ? 0 : errno;
  close(opened);
  return failed == 0 ? Result<void>{} : unwritable_log(path, failed);
}

std::string folder_of(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/work_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "data-schema/files/process_mark.hpp"

namespace tacto::analysis {

namespace fs = std::filesystem;
using schema::Result;

tl::unexpected<schema::Error> unwritable(const std::string& path, int error_number) {
  // The standard library reports a full disk as EIO while it copies.
  const bool may_be_full = error_number == ENOSPC || error_number == EDQUOT || error_number == EIO;
  return schema::fail(schema::ErrorKind::cannot_write,
                      "cannot be written: " + std::generic_category().message(error_number), path,
                      may_be_full ? "is the disk full?" : "");
}

Result<void> make_folder(const std::string& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  return failed ? unwritable(path, failed.value()) : Result<void>{};
}

void remove_folder(const std::string& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

Result<void> sync_file_system(const std::string& folder) {
  const int opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return unwritable(folder, errno);
  const int failed = syncfs(opened) == 0 ? 0 : errno;
  close(opened);
  return failed == 0 ? Result<void>{} : unwritable(folder, failed);
}

WorkFolder::WorkFolder(std::string all)
    : all_(std::move(all)), own_((fs::path(all_) / schema::text_of(schema::own_mark())).string()) {}

WorkFolder::~WorkFolder() {
  remove_folder(own_);
  rmdir(all_.c_str());  // where no other run works
}

std::size_t WorkFolder::remove_ended() const {
  std::vector<std::string> ended;
  std::error_code failed;
  for (fs::directory_iterator at(all_, failed), end; !failed && at != end; at.increment(failed)) {
    const auto mark = schema::parse_mark(at->path().filename().string());
    struct stat status {};
    if (mark && stat(at->path().c_str(), &status) == 0 &&
        schema::liveness_of(*mark, status.st_mtime) == schema::Liveness::ended)
      ended.push_back(at->path().string());
  }
  for (const std::string& folder : ended) remove_folder(folder);
  return ended.size();
}

}  // namespace tacto::analysis

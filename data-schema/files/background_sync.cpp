// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/background_sync.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

namespace tacto::schema {
namespace {

tl::unexpected<Error> not_synced(const std::string& path, int error_number) {
  return fail(ErrorKind::cannot_write,
              "cannot be written to the disk: " + std::generic_category().message(error_number), path);
}

}  // namespace

Result<std::unique_ptr<BackgroundSync>> BackgroundSync::start(const std::vector<std::string>& paths,
                                                              double every_s) {
  std::unique_ptr<BackgroundSync> sync(new BackgroundSync(every_s));
  for (const std::string& path : paths) {
    const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (opened < 0) return not_synced(path, errno);
    sync->files_.push_back({path, opened});
  }
  sync->thread_ = std::thread([&self = *sync] { self.run(); });
  return sync;
}

BackgroundSync::~BackgroundSync() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
  for (const Synced& file : files_) close(file.descriptor);
}

Result<void> BackgroundSync::written() {
  const std::lock_guard lock(mutex_);
  written_ = true;
  return failure_ ? Result<void>(tl::unexpected(*failure_)) : Result<void>{};
}

void BackgroundSync::run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    const bool due = std::exchange(written_, false);
    lock.unlock();
    if (due) sync_all();
    lock.lock();
    changed_.wait_for(lock, std::chrono::duration<double>(every_s_), [this] { return stop_; });
  }
}

void BackgroundSync::sync_all() {
  for (const Synced& file : files_) {
    if (fdatasync(file.descriptor) == 0) continue;
    const int error_number = errno;
    const std::lock_guard lock(mutex_);
    failure_ = not_synced(file.path, error_number).value();
  }
}

}  // namespace tacto::schema

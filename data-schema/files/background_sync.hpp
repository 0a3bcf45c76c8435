// SPDX-License-Identifier: GPL-3.0-or-later
// Syncs files to disk while they are written.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Syncs files periodically on a thread of its own. A sync may take a second on a busy disk. The writer must
/// not wait for it: frames that arrive meanwhile would stay in memory and be lost with the process.
class BackgroundSync {
 public:
  /// The files exist, and may be renamed later. Errors: cannot_write.
  static Result<std::unique_ptr<BackgroundSync>> start(const std::vector<std::string>& paths, double every_s);
  BackgroundSync(const BackgroundSync&) = delete;
  BackgroundSync& operator=(const BackgroundSync&) = delete;
  ~BackgroundSync();

  /// Call it after each write. Does not wait for the disk. Errors: cannot_write, of a sync since then.
  Result<void> written();

 private:
  struct Synced {
    std::string path;
    int descriptor = -1;
  };
  explicit BackgroundSync(double every_s) : every_s_(every_s) {}
  void run();
  void sync_all();

  const double every_s_;
  std::vector<Synced> files_;  // belong to the thread while it runs
  std::mutex mutex_;
  std::condition_variable changed_;
  bool written_ = false, stop_ = false;
  std::optional<Error> failure_;
  std::thread thread_;
};

}  // namespace tacto::schema

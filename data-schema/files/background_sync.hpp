// SPDX-License-Identifier: GPL-3.0-or-later
// Files brought to the disk while they are written. Internal to this folder.
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

/// Syncs files every so often on a thread of its own: a busy disk may take a second for it, and whoever
/// writes must not wait, or what comes meanwhile would stay in memory and die with the process.
class BackgroundSync {
 public:
  /// The files are there, and may take other names later. Errors: cannot_write.
  static Result<std::unique_ptr<BackgroundSync>> start(const std::vector<std::string>& paths, double every_s);
  BackgroundSync(const BackgroundSync&) = delete;
  BackgroundSync& operator=(const BackgroundSync&) = delete;
  ~BackgroundSync();

  /// Says that something was written. Doesn't wait for the disk. Errors: cannot_write, of a sync since then.
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
  std::vector<Synced> files_;  // of the thread, once it runs
  std::mutex mutex_;
  std::condition_variable changed_;
  bool written_ = false, stop_ = false;
  std::optional<Error> failure_;
  std::thread thread_;
};

}  // namespace tacto::schema

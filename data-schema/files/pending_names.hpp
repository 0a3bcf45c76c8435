// SPDX-License-Identifier: GPL-3.0-or-later
// Names of temporary files, and of folders made for outputs, readable for a signal handler.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

namespace tacto::schema {

/// Written while `there` is false; read by a handler while it is true.
struct PendingName {
  std::atomic<bool> there{false};
  std::string path;
  PendingName* next = nullptr;
};

/// A list that only grows, so that a handler can read it at any moment; forgotten entries are used again. Any
/// thread.
class PendingNames {
 public:
  PendingName* keep(const std::string& path);
  void forget(PendingName* name);
  /// Removes all files in the list, and the folders that are empty then. Async-signal-safe.
  void remove_all() const noexcept;

 private:
  std::mutex mutex_;
  std::vector<PendingName*> free_;
  std::atomic<PendingName*> first_{nullptr};
};

/// The list of this process.
PendingNames& pending_names();

}  // namespace tacto::schema

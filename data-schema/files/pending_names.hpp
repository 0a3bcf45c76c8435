// SPDX-License-Identifier: GPL-3.0-or-later
// Names of temporary files, where the handler of a signal finds them.
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

/// A list that only grows, so that a handler can walk it at any moment; what is forgotten is used again. Any
/// thread.
class PendingNames {
 public:
  PendingName* keep(const std::string& path);
  void forget(PendingName* name);
  /// Unlinks all that are there. Async-signal-safe.
  void remove_all() const noexcept;

 private:
  std::mutex mutex_;
  std::vector<PendingName*> free_;
  std::atomic<PendingName*> first_{nullptr};
};

/// The process's one.
PendingNames& pending_names();

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// The file of events of a recording or an experiment in progress: appended to, locked, with reserved room.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Owns the open file and its lock, and releases both at the end; the file itself stays.
class EventFile {
 public:
  /// Creates a file and locks it. Errors: usage, if it exists; cannot_write.
  static Result<EventFile> create(const std::string& path);
  /// Opens an existing file. Errors: not_found; unsuitable, if its writer still has the lock.
  static Result<EventFile> lock(const std::string& path);
  EventFile(EventFile&& other) noexcept;
  EventFile& operator=(EventFile&& other) noexcept;
  ~EventFile();

  /// Errors: cannot_write.
  Result<void> append(const std::string& text);
  /// Releases the room for the sidecar; after this, nothing may be appended.
  void release_room();
  Result<void> remove();

  /// Whether its path still names this file: the folder may have been renamed, or the file deleted.
  bool is_at_its_path() const;
  /// Whether the file has been deleted from every folder.
  bool is_deleted() const;
  /// Its current path, in full; empty if it was deleted, or without /proc.
  std::string place() const;

 private:
  EventFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  std::string path_;
  int descriptor_ = -1;
};

/// Syncs a file, or the names in a folder, to disk. Errors: cannot_write.
Result<void> sync_path(const std::string& path);

/// The folder of a file, "." where it is named without one.
std::string folder_of(const std::string& path);

}  // namespace tacto::schema

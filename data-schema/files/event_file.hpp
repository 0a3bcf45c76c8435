// SPDX-License-Identifier: GPL-3.0-or-later
// The file of events of a recording under way: appended to, locked, with room kept. Internal to this folder.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Owns the open file and its lock, and lets go of both in the end; the file itself stays.
class EventFile {
 public:
  /// A new file, locked. Errors: usage, where it is there; cannot_write.
  static Result<EventFile> create(const std::string& path);
  /// A file that is there. Errors: not_found; unsuitable, where the one who writes it still has it locked.
  static Result<EventFile> lock(const std::string& path);
  EventFile(EventFile&& other) noexcept;
  EventFile& operator=(EventFile&& other) noexcept;
  ~EventFile();

  /// Errors: cannot_write.
  Result<void> append(const std::string& text);
  /// Gives back what was kept for the sidecar; nothing may be appended any more.
  void release_room();
  Result<void> remove();

  /// Whether its path still names this file: somebody may rename its folder, or delete it.
  bool is_at_its_path() const;
  /// Whether no name is left of it in any folder.
  bool is_deleted() const;
  /// Where it is now, in full; empty where it was deleted, or where there is no /proc to ask.
  std::string place() const;

 private:
  EventFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  std::string path_;
  int descriptor_ = -1;
};

/// Brings a file, or the names in a folder, to the disk. Errors: cannot_write.
Result<void> sync_path(const std::string& path);

/// The folder of a file, "." where it is named without one.
std::string folder_of(const std::string& path);

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a session while it runs.
#pragma once

#include <span>

#include "data-schema/files/made_folders.hpp"
#include "data-schema/session/session.hpp"

namespace tacto::schema {

/// Appends whole blocks. After a failure (a full disk) the file ends with its last whole block, and later
/// blocks may be tried again. 4 KiB of the disk are reserved against ticks, 2 KiB against commands and
/// events, so that losses and the end can still be written. Not safe in the tick.
class SessionWriter {
 public:
  /// Errors: usage, where the file is there already; cannot_write; as session_header_text.
  static Result<SessionWriter> create(const std::string& path, const SessionHeader& header);
  SessionWriter(SessionWriter&& other) noexcept;
  SessionWriter& operator=(SessionWriter&& other) noexcept;
  ~SessionWriter();

  /// Any number of ticks, without gaps. Errors: cannot_write.
  Result<void> add(std::span<const SessionTick> ticks);
  /// Samples of the tray's sensor. Errors: cannot_write.
  Result<void> add(const SessionSamples& samples);
  Result<void> add(const SessionCommand& command);
  Result<void> add(const SessionLoss& loss);
  Result<void> add(const SessionEvent& event);
  /// Call before the commands of its upload. Errors: cannot_write; as session_program_text.
  Result<void> add(const SessionChange& change);
  /// Whether there is room for so many more bytes, if the file system can tell (otherwise a write will); the
  /// room is reserved. Errors: cannot_write.
  Result<void> make_room(std::int64_t bytes);
  /// Returns when all added data are on the disk. Errors: cannot_write.
  Result<void> sync();
  /// The last block, and sync(). Errors: cannot_write.
  Result<void> close(const SessionEnd& end);
  const std::string& path() const { return path_; }

 private:
  SessionWriter(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  Result<void> append(const std::string& block, std::int64_t to_keep_free);
  std::string path_;
  MadeFolders folders_;
  int descriptor_ = -1;
  std::int64_t size_ = 0, held_ = 0;  // held_: end of the reserved room
};

}  // namespace tacto::schema

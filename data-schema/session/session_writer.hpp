// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a session as it happens.
#pragma once

#include <span>

#include "data-schema/session/session.hpp"

namespace tacto::schema {

/// Appends whole blocks. After a failure (a full disk) the file ends with its last whole block, and what
/// comes later may be tried again. Of the disk 4 KiB are held back from ticks, 2 KiB from commands and
/// events, so that losses and the end can still be told where nothing else finds room. Not safe in the tick.
class SessionWriter {
 public:
  /// Errors: usage, where the file is there already; cannot_write; as session_header_text.
  static Result<SessionWriter> create(const std::string& path, const SessionHeader& header);
  SessionWriter(SessionWriter&& other) noexcept;
  SessionWriter& operator=(SessionWriter&& other) noexcept;
  ~SessionWriter();

  /// Any number of ticks, one following the other without holes. Errors: cannot_write.
  Result<void> add(std::span<const SessionTick> ticks);
  /// What the tray's sensor measured. Errors: cannot_write.
  Result<void> add(const SessionSamples& samples);
  Result<void> add(const SessionCommand& command);
  Result<void> add(const SessionLoss& loss);
  Result<void> add(const SessionEvent& event);
  /// Before the commands of its upload. Errors: cannot_write; as session_program_text.
  Result<void> add(const SessionChange& change);
  /// Whether there is room for so many bytes more, where the file system tells (else a write will); it is
  /// held. Errors: cannot_write.
  Result<void> make_room(std::int64_t bytes);
  /// Returns when all that was added is on the disk. Errors: cannot_write.
  Result<void> sync();
  /// The last block, and sync(). Errors: cannot_write.
  Result<void> close(const SessionEnd& end);
  const std::string& path() const { return path_; }

 private:
  SessionWriter(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  Result<void> append(const std::string& block, std::int64_t to_keep_free);
  std::string path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0, held_ = 0;  // held_: as far as the disk has promised room
};

}  // namespace tacto::schema

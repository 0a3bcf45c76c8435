// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a session block by block, in little memory, also one that was not closed.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "data-schema/session/session.hpp"

namespace tacto::schema {

using SessionBlock = std::variant<std::vector<SessionTick>, SessionCommand, SessionLoss, SessionEvent,
                                  SessionEnd, SessionChange, SessionSamples>;

/// How a session's file ends.
enum class SessionEnding {
  unread,    ///< not reached yet
  closed,    ///< by its last block
  unclosed,  ///< after a whole block: its writer still runs, or was killed
  damaged,   ///< in bytes that are not a block; the blocks before were read
};

class SessionReader {
 public:
  /// By stem or NAME.session. Errors: not_found; malformed, where there is no header; as
  /// parse_session_header.
  static Result<SessionReader> open(const std::string& name);
  SessionReader(SessionReader&&) noexcept;
  SessionReader& operator=(SessionReader&&) noexcept;
  ~SessionReader();

  const SessionHeader& header() const;
  const std::string& path() const;
  /// The next block, in the order of the file; none at its end. Unknown types are skipped.
  std::optional<SessionBlock> next();
  SessionEnding ending() const;
  /// The end of the last whole block.
  std::uint64_t sound_bytes() const;

 private:
  struct State;
  explicit SessionReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Totals of a whole session.
struct SessionTotals {
  std::uint64_t ticks = 0, commands = 0, lost_ticks = 0, late_ticks = 0;
  std::uint64_t samples = 0;       ///< of the tray's sensor
  std::uint64_t lost_samples = 0;  ///< missing between them
  bool samples_grow = true;        ///< each frame after the one before it
  std::int64_t first_ns = 0, last_ns = 0;
  std::vector<SessionEvent> events;    ///< at most the first 500 and the last 500
  std::uint64_t event_count = 0;       ///< of all
  std::vector<SessionEvent> marks;     ///< the first kMostMarks, with the client's text; not among the events
  std::vector<SessionChange> changes;  ///< the first 1000 that took effect
  std::optional<SessionEnd> end;
  SessionEnding ending = SessionEnding::unread;
};

/// Reads to the end.
SessionTotals session_totals(SessionReader& reader);

}  // namespace tacto::schema

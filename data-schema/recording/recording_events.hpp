// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.events.jsonl: what is known during a recording, a line each; moved into its sidecar at the end.
// Internal to this folder.
#pragma once

#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// The first line: the sidecar as it is before the first sample. Errors: as recording_text().
Result<std::string> begin_line(const RecordingHeader& header);

std::string event_line(const Gap& gap);
std::string event_line(const Mark& mark);
std::string event_line(const ClockPair& pair);
std::string event_line(const FaultNote& fault);

struct EventLog {
  RecordingHeader header;                         ///< with the events in it
  std::string cut_line;                           ///< the rest of a line that was not finished
  std::size_t bad_lines = 0, first_bad_line = 0;  ///< complete lines without content; number of the first
};

/// Reads such a file; invalid lines are skipped and counted. Errors: not_found; unsuitable, if not even the
/// first line is complete; malformed, if it is invalid.
Result<EventLog> read_events(const std::string& path);

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.events.jsonl: what is known of a recording while it is made, a line each, folded into its sidecar at
// the end. Internal to this folder.
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
  RecordingHeader header;  ///< with the events in it
  std::string cut_line;    ///< what is left of a line that was being written when all ended
  std::size_t bad_lines = 0, first_bad_line = 0;  ///< whole ones that say nothing; the first one's number
};

/// Reads such a file; a line that says nothing is passed over and counted. Errors: not_found; unsuitable,
/// where not even the first line is whole; malformed, where that says nothing.
Result<EventLog> read_events(const std::string& path);

}  // namespace tacto::schema

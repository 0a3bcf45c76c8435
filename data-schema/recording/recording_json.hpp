// SPDX-License-Identifier: GPL-3.0-or-later
// A recording's sidecar as JSON and back.
#pragma once

#include "data-schema/json/json_document.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// The sidecar's text. Errors: unsuitable, by JSON pointer, where the header can't be stored (a channel
/// twice, a unit that is not its quantity's, a scale that is not finite ...).
Result<std::string> recording_text(const RecordingHeader& header);

/// The sidecar of a document that fits its schema; other faults are ignored.
RecordingHeader recording_header_unchecked(const Document& document);

/// Faults that a schema cannot express: a unit that is not its quantity's, a channel twice, gaps out of
/// order.
std::vector<Violation> recording_breaches(const RecordingHeader& header);

/// The sidecar of a document that fits its schema; `path` names it in errors. Errors: malformed, by JSON
/// pointer, for faults that a schema cannot express.
Result<RecordingHeader> recording_header_from(const Document& document, const std::string& path);

/// Parts of a sidecar that are also lines of NAME.events.jsonl. From documents that fit the schema only.
Json body_of(const Gap& gap);
Json body_of(const Mark& mark);
Json body_of(const ClockPair& pair);
Json body_of(const FaultNote& fault);
/// These throw if a member is missing or of another type: a journal's lines are not checked by a schema.
Gap gap_from(const Json& body);
Mark mark_from(const Json& body);
ClockPair clock_pair_from(const Json& body);
FaultNote fault_from(const Json& body);

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/recording_events.hpp"

#include <exception>

#include "data-schema/files/files.hpp"
#include "data-schema/json/json_text.hpp"
#include "data-schema/recording/recording_json.hpp"

namespace tacto::schema {
namespace {

// One line; text that is not UTF-8 is kept as far as possible.
std::string line_of(const char* event, const Json& body) {
  Json line = {{"event", event}};
  line.update(body);
  return line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<RecordingHeader> header_in(std::string_view line, const std::string& path) try {
  const auto body = parse_json(line, path);
  TACTO_TRY(body);
  const auto document = parse_document(body->at("recording").dump(), path, "recording");
  return document ? recording_header_from(*document, path) : forward_error(document);
} catch (const std::exception&) {
  return fail(ErrorKind::malformed, "its first line does not describe the recording", path);
}

// Ignores events of a newer version; false for a line that is not an event.
bool add_event(RecordingHeader& header, std::string_view line) try {
  const auto body = parse_json(line, {});
  if (!body) return false;
  const std::string event = body->at("event");
  if (event == "gap") header.gaps.push_back(gap_from(*body));
  if (event == "mark") header.marks.push_back(mark_from(*body));
  if (event == "clock") header.clock_pairs.push_back(clock_pair_from(*body));
  if (event == "fault") header.faults.push_back(fault_from(*body));
  return true;
} catch (const std::exception&) {
  return false;
}

// The next line without its end; text without a line end is not a line.
bool take_line(std::string_view& text, std::string_view& line) {
  const auto end = text.find('\n');
  if (end == std::string_view::npos) return false;
  line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return true;
}

}  // namespace

Result<std::string> begin_line(const RecordingHeader& header) {
  RecordingHeader complete = header;
  complete.sha256 = std::string(64, '0');  // not known yet
  const auto text = recording_text(complete);
  TACTO_TRY(text);
  return line_of("begin", {{"recording", Json::parse(*text)}});
}

std::string event_line(const Gap& gap) {
  return line_of("gap", body_of(gap));
}
std::string event_line(const Mark& mark) {
  return line_of("mark", body_of(mark));
}
std::string event_line(const ClockPair& pair) {
  return line_of("clock", body_of(pair));
}
std::string event_line(const FaultNote& fault) {
  return line_of("fault", body_of(fault));
}

Result<EventLog> read_events(const std::string& path) {
  const auto file = read_file(path);
  TACTO_TRY(file);
  std::string_view text = *file, line;
  if (!take_line(text, line))
    return fail(ErrorKind::unsuitable, "its first line is incomplete: nothing was recorded yet", path,
                "delete it");
  auto header = header_in(line, path);
  TACTO_TRY(header);
  EventLog log{.header = std::move(*header), .cut_line = {}};
  for (std::size_t number = 2; take_line(text, line); ++number)
    if (!add_event(log.header, line) && log.bad_lines++ == 0) log.first_bad_line = number;
  log.cut_line = text;
  return log;
}

}  // namespace tacto::schema

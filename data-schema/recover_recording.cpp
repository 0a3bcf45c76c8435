// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <system_error>

#include "data-schema/event_file.hpp"
#include "data-schema/files.hpp"
#include "data-schema/live_recording.hpp"
#include "data-schema/recording_close.hpp"
#include "data-schema/recording_events.hpp"
#include "data-schema/recording_place.hpp"
#include "data-schema/riff_layout.hpp"

namespace tacto::schema {
namespace {

std::string stem_in(const std::string& name) {
  constexpr std::string_view kEvents = ".events.jsonl";
  return name.ends_with(kEvents) ? name.substr(0, name.size() - kEvents.size()) : stem_of(name, "");
}

Result<void> check_recoverable(const std::string& stem) {
  if (is_file(events_path(stem))) return {};
  if (is_file(stem + ".json"))
    return fail(Fault::unsuitable, "was closed: there is nothing to recover", stem + ".json",
                "'tactograph validate' says whether it is sound");
  return fail(Fault::not_found, "there is no recording under way or broken off", stem,
              "name it by its stem: it has left NAME.wav and NAME.events.jsonl");
}

// Killed before its header was on the disk: nothing had been recorded yet.
Result<void> begin_wav(const std::string& wav, const RecordingHeader& header) {
  if (is_file(wav) && riff_layout(wav)) return {};
  auto writer = WavWriter::create(wav, header.sample_rate_hz, header.channels.size(), header.format);
  return writer ? writer->close() : forward_error(writer);
}

std::optional<Recording> open_closed(const std::string& stem) {
  if (!is_file(stem + ".json")) return std::nullopt;
  auto recording = open_recording(stem);
  return recording ? std::optional(std::move(*recording)) : std::nullopt;
}

std::vector<std::string> notes_on(const EventLog& log, const std::string& wav) {
  std::vector<std::string> notes = {"it was never closed: what came in its last 100 ms may be missing"};
  const auto layout = riff_layout(wav);
  if (layout && layout->block_bytes > 0 && layout->present_bytes % layout->block_bytes != 0)
    notes.push_back(fmt::format("its last frame was broken off: {} bytes of it were cut off",
                                layout->present_bytes % layout->block_bytes));
  if (!log.cut_line.empty()) notes.push_back("its last event was broken off: " + log.cut_line);
  return notes;
}

// Killed after its sidecar was there, before the events were removed: all is well.
Result<Recovered> already_closed(Recording recording, EventFile& events) {
  if (const auto removed = events.remove(); !removed) return forward_error(removed);
  return Recovered{std::move(recording), {}};
}

}  // namespace

Result<Recovered> recover_recording(const std::string& name) {
  const std::string stem = stem_in(name), wav = stem + ".wav";
  if (const auto there = check_recoverable(stem); !there) return forward_error(there);
  auto events = EventFile::lock(events_path(stem));
  if (!events) return forward_error(events);
  if (auto whole = open_closed(stem)) return already_closed(std::move(*whole), *events);
  auto log = read_events(events_path(stem));
  if (!log) return forward_error(log);
  if (const auto begun = begin_wav(wav, log->header); !begun) return forward_error(begun);
  Recovered recovered{{}, notes_on(*log, wav)};
  log->header.ended = "broken off";
  log->header.warnings.insert(log->header.warnings.end(), recovered.notes.begin(), recovered.notes.end());
  auto recording = close_recording(stem, std::move(log->header), *events);
  if (!recording) return forward_error(recording);
  recovered.recording = std::move(*recording);
  return recovered;
}

}  // namespace tacto::schema

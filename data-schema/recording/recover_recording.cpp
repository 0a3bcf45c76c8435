// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "data-schema/files/event_file.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/journal_gaps.hpp"
#include "data-schema/recording/live_recording.hpp"
#include "data-schema/recording/recording_close.hpp"
#include "data-schema/recording/recording_events.hpp"
#include "data-schema/recording/recording_place.hpp"
#include "data-schema/recording/wav_remains.hpp"

namespace tacto::schema {
namespace {

Result<void> check_recoverable(const std::string& stem) {
  if (is_file(events_path(stem))) return {};
  if (is_file(stem + ".json"))
    return fail(ErrorKind::unsuitable, "was closed and needs no recovery", stem + ".json",
                "'tactograph validate' checks it");
  return fail(ErrorKind::not_found, "there is no active or interrupted recording", stem,
              "give its stem: its files are NAME.wav and NAME.events.jsonl");
}

std::optional<Recording> open_closed(const std::string& stem) {
  if (!is_file(stem + ".json")) return std::nullopt;
  auto recording = open_recording(stem);
  return recording ? std::optional(std::move(*recording)) : std::nullopt;
}

// The number of a stored frame from a number that also counts lost frames.
std::uint64_t stored_number(std::uint64_t device_sequence, const std::vector<Gap>& gaps) {
  std::uint64_t lost = 0;
  for (const Gap& gap : gaps)
    if (gap.device_sequence <= device_sequence) lost += gap.count;
  return device_sequence - std::min(device_sequence, lost);
}

// The smallest possible number of frames, from what was noted with them.
std::uint64_t frames_known_of(const RecordingHeader& header) {
  std::uint64_t known = 0;
  for (const Gap& gap : header.gaps) known = std::max(known, gap.frame);
  for (const Mark& mark : header.marks) known = std::max(known, mark.frame);
  for (const FaultNote& fault : header.faults) known = std::max(known, fault.frame);
  for (const ClockPair& pair : header.clock_pairs)
    known = std::max(known, stored_number(pair.device_sequence, header.gaps));
  return known;
}

// Text that a sidecar can contain, from arbitrary bytes.
std::string printable(std::string_view bytes) {
  constexpr std::size_t kMost = 80;
  std::string text(bytes.substr(0, kMost));
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

// Those beyond the samples are removed later, when the samples are counted.
std::vector<std::string> make_gaps_agree(std::vector<Gap>& gaps) {
  AgreedGaps agreed = agreed_gaps(gaps);
  gaps = std::move(agreed.gaps);
  std::vector<std::string> notes;
  if (agreed.left_out > 0)
    notes.push_back(fmt::format(
        "{} gaps of its journal contradict those before them and were ignored: its time may be wrong there",
        agreed.left_out));
  if (agreed.untold > 0)
    notes.push_back(
        fmt::format("{} missing frames are in no readable line of its journal: they were added to the next "
                    "gap, so the time before it is too early",
                    agreed.untold));
  return notes;
}

std::vector<std::string> notes_on(const EventLog& log) {
  std::vector<std::string> notes = {
      "it was not closed: its last 100 ms may be missing (up to 1 s after a power cut with a busy disk)"};
  if (!log.cut_line.empty()) notes.push_back("its last event is incomplete: " + printable(log.cut_line));
  if (log.bad_lines > 0)
    notes.push_back(
        fmt::format("{} lines of its journal are not readable (the first is line {}) and were ignored: a "
                    "gap, a mark or a fault may be unknown, and a gap in time undetected",
                    log.bad_lines, log.first_bad_line));
  return notes;
}

// Killed after the sidecar was written, before the events were removed: nothing is lost.
Result<Recovered> already_closed(Recording recording, EventFile& events) {
  TACTO_TRY(events.remove());
  return Recovered{std::move(recording), {}};
}

}  // namespace

Result<Recovered> recover_recording(const std::string& name) {
  const std::string stem = recording_stem_of(name), wav = stem + ".wav";
  TACTO_TRY(check_recoverable(stem));
  auto events = EventFile::lock(events_path(stem));
  TACTO_TRY(events);
  if (auto whole = open_closed(stem)) return already_closed(std::move(*whole), *events);
  auto log = read_events(events_path(stem));
  TACTO_TRY(log);
  const auto gap_notes = make_gaps_agree(log->header.gaps);
  const auto remains = salvage_wav(wav, log->header, frames_known_of(log->header));
  TACTO_TRY(remains);
  Recovered recovered{{}, notes_on(*log)};
  recovered.notes.insert(recovered.notes.end(), gap_notes.begin(), gap_notes.end());
  recovered.notes.insert(recovered.notes.end(), remains->notes.begin(), remains->notes.end());
  const auto said_before = static_cast<std::ptrdiff_t>(log->header.warnings.size());
  log->header.ended = "broken off";
  log->header.warnings.insert(log->header.warnings.end(), recovered.notes.begin(), recovered.notes.end());
  auto recording = close_recording(stem, std::move(log->header), *events);
  TACTO_TRY(recording);
  const auto& warnings = recording->header.warnings;  // closing adds its own
  recovered.notes.assign(warnings.begin() + said_before, warnings.end());
  recovered.recording = std::move(*recording);
  return recovered;
}

}  // namespace tacto::schema

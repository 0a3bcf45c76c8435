// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/files/event_file.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/live_recording.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/recording_close.hpp"
#include "data-schema/recording/recording_events.hpp"
#include "data-schema/recording/recording_place.hpp"
#include "data-schema/wav/riff_layout.hpp"
#include "data-schema/wav/riff_length.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

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

struct AgreedGaps {
  std::vector<Gap> gaps;     // growing, none of them twice
  std::size_t left_out = 0;  // of those that contradicted the ones before them
  std::uint64_t untold = 0;  // missing frames without a line, added to the gap after them
};

bool same_gap(const Gap& a, const Gap& b) {
  return a.frame == b.frame && a.device_sequence == b.device_sequence && a.count == b.count;
}

// A gap's device_sequence counts all missing frames before its first frame: from it one sees that an earlier
// line is lost, or that a line is there twice. Precondition: gaps of frames that exist.
AgreedGaps agreed_gaps(const std::vector<Gap>& gaps) {
  AgreedGaps agreed;
  std::uint64_t missing = 0;
  Gap last;
  for (Gap gap : gaps) {
    const std::uint64_t first_missing = gap.frame + missing;
    if (gap.frame < last.frame || gap.count == 0 || gap.device_sequence < first_missing ||
        same_gap(gap, last)) {
      ++agreed.left_out;
      continue;
    }
    last = gap;
    const std::uint64_t all = gap.device_sequence - first_missing;
    agreed.untold += all - std::min(all, gap.count);
    gap.count = std::max(all, gap.count);
    missing += gap.count;
    agreed.gaps.push_back(gap);
  }
  return agreed;
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
  std::vector<std::string> notes = {fmt::format(
      "it was not closed: its last {} may be missing (up to {} after a power cut with a busy disk)",
      for_people(kMostLost_s, Dimension::time), for_people(kMostLostBusy_s, Dimension::time))};
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

// The content of such a WAV.
struct WavRemains {
  std::uint64_t frames = 0;
  std::vector<std::string> notes;  // what was repaired, what was cut off, what may be lost
};

constexpr double kOnItsWay_s = 0.1;         // events are in the journal before their frames are in the WAV
constexpr std::size_t kFormatBytes = 48;    // "fmt " with its size and content
constexpr std::uint64_t kPageBytes = 4096;  // a file system loses whole pages

// What tactograph's writer puts before the first sample.
struct EmptyWav {
  std::string bytes;
  RiffLayout layout;
  std::string_view format() const {
    return std::string_view(bytes).substr(layout.format_at - 8, kFormatBytes);
  }
};

// Taken from the writer itself: another version of libsndfile may write another header.
Result<EmptyWav> empty_wav(const std::string& wav, const RecordingHeader& header) {
  PendingFiles beside;  // never committed
  const auto path = beside.add(wav);
  TACTO_TRY(path);
  auto writer = WavWriter::create(*path, header.sample_rate_hz, header.channels.size(), header.format);
  TACTO_TRY(writer);
  TACTO_TRY(writer->close());
  const auto layout = riff_layout(*path);
  auto bytes = read_file(*path);
  TACTO_TRY(bytes);
  if (!layout || layout->format_at < 8 || layout->data_at < layout->format_at + kFormatBytes - 8)
    return fail(ErrorKind::internal, "an empty WAV has an unknown header", *path);
  return EmptyWav{std::move(*bytes), *layout};
}

std::string first_bytes(const std::string& path, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(count));
  return bytes;
}

bool is_sound(const std::string& wav, const EmptyWav& empty) {
  const auto layout = riff_layout(wav);
  if (!layout || layout->data_at > kPageBytes || layout->format_at < 8) return false;
  return first_bytes(wav, layout->data_at).substr(layout->format_at - 8, kFormatBytes) == empty.format();
}

bool same_or_lost(std::string_view found, std::string_view ours) {
  return std::ranges::equal(found, ours, [](char a, char b) { return a == b || a == '\0'; });
}

// Zeros in place of its header; the first bytes of the header, which change, may contain anything.
bool is_remnant(const std::string& wav, const EmptyWav& empty) {
  const std::string head = first_bytes(wav, empty.layout.data_at);
  const std::string_view found = head, ours = std::string_view(empty.bytes);
  return same_or_lost(found.substr(8, 4), ours.substr(8, 4)) &&
         same_or_lost(found.substr(empty.layout.format_at - 8, kFormatBytes), empty.format()) &&
         same_or_lost(found.substr(empty.layout.data_at - 8, 4), ours.substr(empty.layout.data_at - 8, 4));
}

tl::unexpected<Error> unknown_content(const std::string& wav, const EmptyWav& empty) {
  const auto bytes = empty.layout.data_at;
  return fail(ErrorKind::malformed,
              fmt::format("is not the WAV of this recording: its first {} bytes are neither its header nor "
                          "zeros; nothing was changed",
                          bytes),
              wav,
              fmt::format("if the frames after them are intact, use 'dd if=/dev/zero of={} bs={} count=1 "
                          "conv=notrunc' on a copy, then recover it",
                          wav, bytes));
}

Result<void> write_header(const std::string& wav, const EmptyWav& empty) {
  std::fstream file(wav, std::ios::binary | std::ios::in | std::ios::out);
  file.write(empty.bytes.data(), static_cast<std::streamsize>(empty.layout.data_at));
  file.close();
  return file ? Result<void>{} : fail(ErrorKind::cannot_write, "its header cannot be written", wav);
}

Result<void> cut_off_at(const std::string& wav, std::uint64_t bytes) {
  std::error_code failed;
  fs::resize_file(wav, bytes, failed);
  return failed ? fail(ErrorKind::cannot_write, "cannot be shortened: " + failed.message(), wav)
                : Result<void>{};
}

std::uint64_t size_of(const std::string& path) {
  std::error_code unknown;
  const auto size = fs::file_size(path, unknown);
  return unknown ? 0 : size;
}

std::string shown(std::uint64_t frames, const RecordingHeader& header) {
  return fmt::format("{} frames ({:.3g} s)", frames, static_cast<double>(frames) / header.sample_rate_hz);
}

Result<void> check_holds_something(const std::string& wav, const EmptyWav& empty,
                                   const RecordingHeader& header, std::uint64_t known_frames) {
  const std::uint64_t block = empty.layout.block_bytes;
  const bool early = static_cast<double>(known_frames) <= kOnItsWay_s * header.sample_rate_hz;
  if (early || size_of(wav) >= empty.layout.data_at + block) return {};
  return fail(ErrorKind::malformed,
              fmt::format("contains no frames, but its journal lists {}; nothing was changed", known_frames),
              wav, "look for the WAV elsewhere (lost+found, a backup) and copy it here");
}

constexpr std::uint64_t kPieceFrames = 16384;

// Whole frames, piece by piece.
class FrameBytes {
 public:
  FrameBytes(const std::string& path, const RiffLayout& layout)
      : file_(path, std::ios::binary), layout_(layout) {}

  std::uint64_t frames() const { return layout_.present_bytes / layout_.block_bytes; }
  std::uint64_t frame_of(std::size_t byte) const { return byte / layout_.block_bytes; }
  // Empty if it cannot be read.
  std::string piece(std::uint64_t first, std::uint64_t count) {
    std::string bytes(count * layout_.block_bytes, '\0');
    file_.seekg(static_cast<std::streamoff>(layout_.data_at + first * layout_.block_bytes));
    if (!file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) bytes.clear();
    return bytes;
  }

 private:
  std::ifstream file_;
  const RiffLayout& layout_;
};

// The number of frames from the first on with zeros in all their bytes. Only whole frames count; 0 for a
// file that cannot be read.
std::uint64_t zero_frames_at_start(const std::string& path, const RiffLayout& layout) {
  FrameBytes bytes(path, layout);
  for (std::uint64_t first = 0; first < bytes.frames(); first += kPieceFrames) {
    const std::string piece = bytes.piece(first, std::min(kPieceFrames, bytes.frames() - first));
    if (piece.empty()) return first;
    const std::size_t found = piece.find_first_not_of('\0');
    if (found != std::string::npos) return first + bytes.frame_of(found);
  }
  return bytes.frames();
}

// The same up to the last whole frame.
std::uint64_t zero_frames_at_end(const std::string& path, const RiffLayout& layout) {
  FrameBytes bytes(path, layout);
  for (std::uint64_t end = bytes.frames(); end > 0;) {
    const std::uint64_t count = std::min(kPieceFrames, end);
    const std::string piece = bytes.piece(end - count, count);
    const std::size_t found = piece.find_last_not_of('\0');
    if (piece.empty() || found != std::string::npos)
      return bytes.frames() - (piece.empty() ? end : end - count + bytes.frame_of(found) + 1);
    end -= count;
  }
  return bytes.frames();
}

// The header's sizes are written after the frames that they count.
Result<void> cut_unwritten(const std::string& wav, const RecordingHeader& header, WavRemains& remains) {
  const auto layout = riff_layout(wav);
  const auto length = riff_length(wav);
  if (!length) return {};
  const std::uint64_t frames = layout->present_bytes / layout->block_bytes;
  const std::uint64_t written = frames - zero_frames_at_end(wav, *layout);
  const std::uint64_t kept = std::clamp(length->promised_frames, std::min(written, frames), frames);
  if (kept == frames) return {};
  remains.notes.push_back(fmt::format("its last {} were zeros that had not been written: they were removed",
                                      shown(frames - kept, header)));
  return cut_off_at(wav, layout->data_at + kept * layout->block_bytes);
}

void note_zeros(const std::string& wav, const RiffLayout& layout, const RecordingHeader& header,
                WavRemains& remains) {
  const std::uint64_t first = zero_frames_at_start(wav, layout), last = zero_frames_at_end(wav, layout);
  const auto note = [&](const char* where, std::uint64_t frames) {
    remains.notes.push_back(
        fmt::format("its {} {} are zeros: they may be lost", where, shown(frames, header)));
  };
  if ((first + 1) * layout.block_bytes > kPageBytes - layout.data_at) note("first", first);
  if (last * layout.block_bytes >= kPageBytes && last < remains.frames) note("last", last);
}

void note_what_is_missing(const RecordingHeader& header, std::uint64_t known_frames, WavRemains& remains) {
  if (known_frames > remains.frames)
    remains.notes.push_back(fmt::format("its journal lists frame {}, but it ends at {}: at least {} are lost",
                                        known_frames, remains.frames,
                                        shown(known_frames - remains.frames, header)));
}

Result<void> make_header_sound(const std::string& wav, const EmptyWav& empty, WavRemains& remains) {
  if (!is_remnant(wav, empty)) return unknown_content(wav, empty);
  if (size_of(wav) >= empty.layout.data_at)
    remains.notes.push_back(
        "the header of its WAV was damaged and was rewritten: frames near it may be damaged, too");
  return write_header(wav, empty);
}

// Writes the header again if a power cut left zeros in it, by the format of `header`. Cuts off an incomplete
// frame, and frames of zeros beyond the length in the WAV's header: reserved space without samples.
// `known_frames`: frames that the journal records. Changes nothing in a file that it cannot read. Errors:
// not_found, without a WAV; malformed, if its first bytes are neither its header nor zeros, or if it is
// empty although the journal records more than what may have been on its way; cannot_write.
Result<WavRemains> salvage_wav(const std::string& wav, const RecordingHeader& header,
                               std::uint64_t known_frames) {
  if (!is_file(wav))
    return fail(ErrorKind::not_found, "is missing: only its journal exists", wav,
                "copy it to the folder of the journal; if nothing was recorded, delete the journal");
  const auto empty = empty_wav(wav, header);
  TACTO_TRY(empty);
  TACTO_TRY(check_holds_something(wav, *empty, header, known_frames));
  WavRemains remains;
  const bool sound = is_sound(wav, *empty);
  TACTO_TRY(sound ? Result<void>{} : make_header_sound(wav, *empty, remains));
  // A lost header states no length.
  TACTO_TRY(sound ? cut_unwritten(wav, header, remains) : Result<void>{});
  const auto layout = riff_layout(wav);
  if (!layout) return fail(ErrorKind::malformed, "is not a WAV file", wav);
  remains.frames = layout->present_bytes / layout->block_bytes;
  note_zeros(wav, *layout, header, remains);
  if (const auto left = layout->present_bytes % layout->block_bytes; left != 0)
    remains.notes.push_back(fmt::format("its last frame was incomplete: its {} bytes were removed", left));
  note_what_is_missing(header, known_frames, remains);
  return remains;
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

// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a recording in progress so that it can be recovered after a crash or a power cut.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// What a power cut may lose, at most: with a disk that syncs in less than kSyncEvery_s, and with a busy one.
inline constexpr double kMostLost_s = 0.1, kMostLostBusy_s = 1;

/// The pause between two syncs. With blocks of 20 ms and a disk that syncs in as long again, a power cut
/// loses less than 100 ms; a busy disk may take a second for a sync, and a power cut then loses that much. A
/// killed process loses only the block that was not yet written, whatever the disk does.
inline constexpr double kSyncEvery_s = 0.05;

/// Writes NAME.wav (32-bit codes, header kept up to date) and NAME.events.jsonl (the future sidecar, then
/// gaps, marks, clock pairs and faults, a line each) as they come; a thread of its own syncs both to disk,
/// with pauses of kSyncEvery_s. close() moves the events into NAME.json. Without close(), it leaves both
/// files, from which recover_recording() makes the recording. The events' file reserves room for the sidecar
/// on file systems that can, so that a full disk does not prevent closing. One thread at a time.
class LiveRecording {
 public:
  /// `name` as RecordingWriter::create(); the header's format must be pcm32. Errors: usage, where anything of
  /// that name is there; cannot_write; unsuitable, as RecordingWriter::create().
  static Result<LiveRecording> create(const std::string& name, RecordingHeader header);
  LiveRecording(LiveRecording&&) noexcept;
  LiveRecording& operator=(LiveRecording&&) noexcept;
  ~LiveRecording();

  /// Appends whole frames; doesn't wait for the disk. Errors: cannot_write (disk full, a sync that failed
  /// ...): then close() keeps all whole frames that were written.
  Result<void> write(std::span<const std::int32_t> interleaved);
  /// Append to the events, and to the header. Errors: cannot_write.
  Result<void> add(const Gap& gap);
  Result<void> add(const Mark& mark);
  Result<void> add(const ClockPair& pair);
  Result<void> add(const FaultNote& fault);

  /// For warnings and the reason of an early end.
  RecordingHeader& header();
  /// Frames written.
  std::uint64_t frames() const;

  /// Corrects the WAV's header, moves the events into the sidecar and removes their file. Call it once.
  /// Errors: cannot_write, also if the files were renamed or deleted meanwhile; unsuitable. After an error
  /// the recording can still be recovered, from the place that the error names.
  Result<Recording> close();
  /// Instead of close(), if there is nothing to keep: removes both files. Errors: cannot_write.
  Result<void> discard();

 private:
  struct State;
  explicit LiveRecording(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What was made of a recording that was never closed.
struct Recovered {
  Recording recording;
  std::vector<std::string> notes;  ///< what was lost and what was repaired; also its warnings
};

/// Makes a recording from the files of a LiveRecording that was not closed: writes the WAV's header again if
/// it was lost, cuts off an unfinished frame and zeros that were never written, writes the sidecar with the
/// events, removes their file. `name` as open_recording(). Errors: not_found, also if the WAV is missing;
/// unsuitable, if the recording was closed, or is still in progress; malformed, if journal or WAV belong to
/// something else, or the WAV contains nothing of what the journal records, and then nothing is changed;
/// cannot_write.
Result<Recovered> recover_recording(const std::string& name);

}  // namespace tacto::schema

// SPDX-License-Identifier: GPL-3.0-or-later
// A recording while it is made: whatever happens, what was written stays.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// The pause between two syncs. With blocks of 20 ms and a disk that syncs in as long again, a power cut
/// loses less than 100 ms; a busy disk may take a second for a sync, and a power cut then loses that much. A
/// killed process loses only the block that was not yet written, whatever the disk does.
inline constexpr double kSyncEvery_s = 0.05;

/// Writes NAME.wav (32-bit codes, header kept true) and NAME.events.jsonl (what the sidecar will say, then
/// gaps, marks, clock pairs and faults, a line each) as they come; a thread of its own brings both to the
/// disk, with pauses of kSyncEvery_s. close() folds the events into NAME.json. Dropped without close(), or
/// killed, it leaves both files, from which recover_recording() makes the recording. The events' file keeps
/// room for the sidecar on file systems that can, so that a full disk does not prevent closing. One thread at
/// a time.
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

  /// Puts the WAV's header right, folds the events into the sidecar and removes their file. Once only.
  /// Errors: cannot_write, also where the files were renamed or deleted meanwhile; unsuitable. After one the
  /// recording can still be recovered, from where the error says.
  Result<Recording> close();
  /// Instead of close(), where there is nothing to keep: removes both files. Errors: cannot_write.
  Result<void> discard();

 private:
  struct State;
  explicit LiveRecording(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What was made of a recording that was never closed.
struct Recovered {
  Recording recording;
  std::vector<std::string> notes;  ///< what was lost, and what was put right; also its warnings
};

/// Makes a recording of what a LiveRecording left: writes the WAV's header anew where it was lost, cuts off
/// an unfinished frame and zeros that were never written, writes the sidecar with the events, removes their
/// file. `name` as open_recording(). Errors: not_found, also where the WAV is missing; unsuitable, where the
/// recording was closed, or is still being made; malformed, where journal or WAV are of something else, or
/// the WAV holds nothing of what the journal knows, and then nothing is changed; cannot_write.
Result<Recovered> recover_recording(const std::string& name);

}  // namespace tacto::schema

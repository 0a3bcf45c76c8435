// SPDX-License-Identifier: GPL-3.0-or-later
// The flight recorder: keeps a session on disk without ever holding up who plays.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "data-schema/session/session_writer.hpp"
#include "firmware-host/core/kernel/ring.hpp"
#include "playback/player/live_limits.hpp"

namespace tacto::playback {

/// What to do when the recorder's queue is full: lose the tick and count it, or wait (in emulated time, which
/// nobody feels).
enum class FullQueue { lose, wait };

/// What is on its way to the disk, and what will never get there.
struct RecorderCounts {
  std::uint64_t ticks = 0;       ///< written
  std::uint64_t queue_lost = 0;  ///< the queue was full
  std::uint64_t disk_lost = 0;   ///< the disk took nothing
  std::uint64_t late = 0;        ///< of the written, late ones
  std::string failure;           ///< the disk's last words; empty while it works

  std::uint64_t lost() const { return queue_lost + disk_lost; }
};

/// tick() puts into a queue of 65,536 (3 s at 20 kHz, 2 MB), without a lock, allocation or system call (but
/// for the tick that finds room again: it notes what was lost); a thread of its own writes, and syncs every
/// 100 ms. All else is for the same one thread as tick(), and takes a lock that the writer never holds while
/// it writes.
class FlightRecorder {
 public:
  /// `limits`, where given, hears on the writer's thread (of the beginning on start()'s) what is to be
  /// written, and outlives the recorder. Of what is recorded nothing is written before start(). Errors: as
  /// SessionWriter::create.
  static schema::Result<std::unique_ptr<FlightRecorder>> begin(const std::string& path,
                                                               const schema::SessionHeader& header,
                                                               FullQueue full, LiveLimits* limits = nullptr);
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;
  ~FlightRecorder();

  /// Before the first tick, once: returns when what was recorded so far is on the disk, without which no tick
  /// can be replayed; from then on all is written by itself. Errors: cannot_write, also where there is no
  /// room for a first block of ticks.
  schema::Result<void> start();
  void tick(const schema::SessionTick& tick) noexcept;
  void command(schema::SessionCommand command);
  /// What the commands that come next are to change to.
  void change(schema::SessionChange change);
  /// Ticks that never came.
  void loss(const schema::SessionLoss& loss);
  void event(schema::SessionEvent event);
  /// What the tray's sensor measured. Where over 2^18 samples wait for the disk, these are left out: the
  /// numbers of the frames show it.
  void measured(schema::SessionSamples samples);

  RecorderCounts counts() const;
  const std::string& path() const { return path_; }
  /// Removes the file: nothing has happened that was worth it. Nothing may be recorded after it.
  void discard();
  /// Writes what is left and the last block. Errors: cannot_write.
  schema::Result<void> close();

 private:
  static constexpr std::uint32_t kQueue = 65536;
  struct Notes {
    std::vector<std::variant<schema::SessionCommand, schema::SessionChange>> commands;  // as they came
    std::vector<schema::SessionLoss> losses;
    std::vector<schema::SessionEvent> events;
    std::vector<schema::SessionSamples> samples;
    std::size_t sample_count = 0;
  };
  FlightRecorder(schema::SessionWriter writer, FullQueue full, LiveLimits* limits);
  schema::Result<void> write_beginning();
  void run();
  void stop();
  void write_queued();
  void write_ticks(std::uint32_t most);
  void write_run(std::span<const schema::SessionTick> ticks);
  void write_notes();
  void write_owed();
  void failed(const schema::Error& error);
  void confess();
  void owe(const schema::SessionLoss& loss);

  schema::SessionWriter writer_;
  std::string path_;
  FullQueue full_;
  LiveLimits* limits_;  // the writer's
  core::Ring<schema::SessionTick, kQueue> queue_;
  std::atomic<std::uint64_t> queue_lost_{0}, disk_lost_{0}, written_{0}, late_{0}, link_lost_{0};
  std::uint64_t missing_ = 0, missing_from_ = 0;  // the putter's: ticks that found no room
  std::vector<schema::SessionTick> batch_;        // the writer's
  std::vector<schema::SessionLoss> owed_;         // the writer's: losses that the disk did not take either
  bool disk_full_ = false;                        // the writer's
  mutable std::mutex notes_mutex_;
  Notes notes_;
  std::optional<schema::Error> failure_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace tacto::playback

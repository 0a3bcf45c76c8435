// SPDX-License-Identifier: GPL-3.0-or-later
// The flight recorder: writes a session to disk without delaying the player.
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

/// If the recorder's queue is full: drop the tick and count it, or wait (in emulated time, where a delay has
/// no effect).
enum class FullQueue { lose, wait };

/// Counts of ticks that were written, and of those that are lost.
struct RecorderCounts {
  std::uint64_t ticks = 0;       ///< written
  std::uint64_t queue_lost = 0;  ///< the queue was full
  std::uint64_t disk_lost = 0;   ///< the disk did not accept them
  std::uint64_t late = 0;        ///< late ticks among those written
  std::string failure;           ///< the last error of the disk; empty if there is none

  std::uint64_t lost() const { return queue_lost + disk_lost; }
};

/// tick() writes to a queue of 65,536 (3 s at 20 kHz, 4 MB), without a lock, allocation or system call
/// (except for the first tick after a loss, which records it). A thread of the recorder writes to the disk,
/// and syncs every 100 ms. All other functions are for the thread of tick(), and use a lock that the writer
/// does not hold while it writes.
class FlightRecorder {
 public:
  /// `limits`, if given, receives what is to be written, on the writer's thread (the beginning on the thread
  /// of start()), and must outlive the recorder. Nothing is written before start(). Errors: as
  /// SessionWriter::create.
  static schema::Result<std::unique_ptr<FlightRecorder>> begin(const std::string& path,
                                                               const schema::SessionHeader& header,
                                                               FullQueue full, LiveLimits* limits = nullptr);
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;
  ~FlightRecorder();

  /// Call once, before the first tick. Returns when everything recorded so far is on the disk, without which
  /// no tick can be replayed; from then on the writer's thread writes. Errors: cannot_write, also if there is
  /// no space for a first block of ticks.
  schema::Result<void> start();
  void tick(const schema::SessionTick& tick) noexcept;
  void command(schema::SessionCommand command);
  /// The textures of the change whose commands follow.
  void change(schema::SessionChange change);
  /// Ticks that were not received.
  void loss(const schema::SessionLoss& loss);
  void event(schema::SessionEvent event);
  /// Samples of the tray's sensor. If over 2^18 samples wait for the disk, these are dropped; the frame
  /// numbers show it.
  void measured(schema::SessionSamples samples);

  RecorderCounts counts() const;
  const std::string& path() const { return path_; }
  /// Removes the file, if there is nothing worth keeping. Nothing may be recorded after it.
  void discard();
  /// Writes the remaining data and the last block. Errors: cannot_write.
  schema::Result<void> close();

 private:
  static constexpr std::uint32_t kQueue = 65536;
  struct Notes {
    std::vector<std::variant<schema::SessionCommand, schema::SessionChange>> commands;  // in order
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
  void write_losses();
  void failed(const schema::Error& error);
  void record_loss();
  void queue_loss(const schema::SessionLoss& loss);

  schema::SessionWriter writer_;
  std::string path_;
  FullQueue full_;
  LiveLimits* limits_;  // of the writer's thread
  core::Ring<schema::SessionTick, kQueue> queue_;
  std::atomic<std::uint64_t> queue_lost_{0}, disk_lost_{0}, written_{0}, late_{0}, link_lost_{0};
  std::uint64_t missing_ = 0, missing_from_ = 0;  // of tick()'s thread: ticks that found no space
  std::vector<schema::SessionTick> batch_;        // of the writer's thread
  std::vector<schema::SessionLoss>
      unwritten_losses_;    // of the writer's thread: losses that are not on the disk yet
  bool disk_full_ = false;  // of the writer's thread
  mutable std::mutex notes_mutex_;
  Notes notes_;
  std::optional<schema::Error> failure_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace tacto::playback

// SPDX-License-Identifier: GPL-3.0-or-later
// The thread that brings captured blocks to the disk.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "capture/record/block_queue.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/recording/live_recording.hpp"

namespace tacto::capture {

/// Takes blocks from the capturing thread and writes them, gaps and marks before the frames they stand with.
/// to_fill(), filled(), end() and failed() are the capturing thread's; after end() the recording is its own
/// again. A failure to write is kept, and what comes after it is passed over.
class DiskWriter {
 public:
  /// `live` outlives this; `codes` is the room of a block.
  DiskWriter(schema::LiveRecording& live, std::size_t codes);
  ~DiskWriter();

  FrameBlock& to_fill() { return queue_.to_fill(); }
  void filled() { queue_.filled(); }
  /// Waits until all is written. Once, at the latest in the destructor.
  void end();
  bool failed() const { return failed_; }
  /// After end(), where it failed.
  const schema::Error& error() const { return error_; }

 private:
  void run();
  schema::Result<void> write(const FrameBlock& block);

  schema::LiveRecording& live_;
  BlockQueue queue_;
  std::atomic<bool> failed_ = false;
  schema::Error error_;
  std::thread thread_;
};

}  // namespace tacto::capture

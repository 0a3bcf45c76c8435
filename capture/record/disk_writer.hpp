// SPDX-License-Identifier: GPL-3.0-or-later
// The thread that writes captured blocks to the disk.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "capture/record/block_queue.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/recording/live_recording.hpp"

namespace tacto::capture {

/// Writes the blocks of the capturing thread; gaps and marks are written before the frames of their block.
/// Only the capturing thread calls to_fill(), filled(), end() and failed(); after end() it may use the
/// recording again. After a write error, which is kept, all further blocks are dropped.
class DiskWriter {
 public:
  /// `live` must exist as long as this object; `codes` is the size of a block.
  DiskWriter(schema::LiveRecording& live, std::size_t codes);
  ~DiskWriter();

  FrameBlock& to_fill() { return queue_.to_fill(); }
  void filled() { queue_.filled(); }
  /// Waits until all blocks are written. Later calls do nothing; the destructor calls it, too.
  void end();
  bool failed() const { return failed_; }
  /// After end(), if failed().
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
